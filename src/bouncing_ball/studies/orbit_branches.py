"""Existence and stability of n-T orbits by continuation (Figs. 8, 9 and 15)."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.contacts.release import Release
from bouncing_ball.continuation.branch import ContinuationError, resample
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.grazing import grazing_points
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.parameters import Family, FrequencyRatio, LossyRestitution, Many, Parameters
from bouncing_ball.studies.columns import OBSERVED, PLACE, columns
from bouncing_ball.studies.continuation import (
    PERIOD_DOUBLING,
    SADDLE_NODE,
    Continuation,
    branch_along_amplitude,
    missing,
)
from bouncing_ball.studies.parameters import BranchEnd, Points

GRAZING = "grazing"


class Domains(Parameters):
    """One family on several contacts, followed along Λ."""

    n: Family
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: BranchEnd
    points: Points


class BothDomains(Parameters):
    """One family on one contact and in the restitution model, followed along Λ."""

    n: Family
    restitution: LossyRestitution
    frequency_ratio: FrequencyRatio
    amplitude_max: BranchEnd
    points: Points


class _Row(NamedTuple):
    """One branch: columns along it, its special points, and why it ends."""

    columns: dict[str, np.ndarray]
    kinds: list[str]
    special: dict[str, np.ndarray]
    reasons: list[str]


def _along(orbit: Orbit) -> dict[str, np.ndarray]:
    """What is published of the orbits of a branch."""
    floquet = orbit.multipliers()
    return {
        **columns(orbit, "amplitude", *OBSERVED),
        "multiplier_real": floquet.real,
        "multiplier_imag": floquet.imag,
        "residual": orbit.defect(),
    }


def _places(orbit: Orbit) -> dict[str, np.ndarray]:
    """Where special orbits are."""
    return {**{name: getattr(orbit, name) for name in PLACE}, "residual": orbit.defect()}


def _row(ratio: float, parameters: Domains, release: Release, continuation: Continuation) -> _Row:
    """The branch of one contact; NaN, with the reason, where it cannot be followed."""
    n, count, newton = parameters.n, parameters.points, continuation.newton()
    try:
        system, branch = branch_along_amplitude(
            n, parameters.restitution, ratio, parameters.amplitude_max, release, continuation
        )
        y = resample(system, branch, count, newton)
    except (NoOrbitError, ContinuationError) as error:
        none = missing(n, count)
        return _Row(_along(none), [], _places(none[:0]), [str(error)] * 2)
    chosen = [s for s in branch.special if s.name in (SADDLE_NODE, PERIOD_DOUBLING)]
    grazing = grazing_points(system, lambda z: system.orbit(z).is_admissible(), y, newton)
    points = np.array([*(s.point for s in chosen), *grazing]).reshape(-1, y.shape[-1])
    return _Row(
        _along(system.orbit(y)),
        [*(s.name for s in chosen), *[GRAZING] * len(grazing)],
        _places(system.orbit(points)),
        [str(branch.start), str(branch.end)],
    )


def _ragged(rows, fill=np.nan):
    """Rows of different lengths as one array, filled at the end."""
    width = max(len(row) for row in rows)
    out = np.full((len(rows), width), fill, dtype=object if isinstance(fill, str) else float)
    for row, values in zip(out, rows, strict=True):
        row[: len(values)] = values
    return out.astype(str) if isinstance(fill, str) else out


def orbit_branches(parameters: Domains, release: Release, continuation: Continuation) -> xr.Dataset:
    """Branches along Λ for one n and several ϖ, shape (ϖ, point) (Figs. 8 and 9).

    Phases in rad; ``special_…`` are the saddle-nodes, period doublings and grazing orbits of
    each branch, shape (ϖ, special). NaN where a branch cannot be followed; ``end_reason`` says
    why it ends.
    """
    ratios = parameters.frequency_ratio
    rows = [_row(ratio, parameters, release, continuation) for ratio in ratios]
    dims, special = ("frequency_ratio", "point"), ("frequency_ratio", "special")
    dataset = xr.Dataset(coords={"frequency_ratio": np.array(ratios)})
    for name in rows[0].columns:
        own = (*dims, "multiplier") if name.startswith("multiplier") else dims
        dataset[name] = (own, np.array([row.columns[name] for row in rows]))
    dataset["special_kind"] = (special, _ragged([row.kinds for row in rows], ""))
    for name in rows[0].special:
        dataset[f"special_{name}"] = (special, _ragged([row.special[name] for row in rows]))
    dataset["end_reason"] = (("frequency_ratio", "end"), np.array([row.reasons for row in rows]))
    return describe(dataset.assign_coords(end=["unstable side", "stable side"]))


def both_domains(
    parameters: BothDomains, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one ϖ, as :func:`orbit_branches`, and that of the restitution model (Fig. 15).

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit up to ``amplitude_max``.
    """
    n, r, top = parameters.n, parameters.restitution, parameters.amplitude_max
    one = dict(parameters) | {"frequency_ratio": (parameters.frequency_ratio,)}
    contact = orbit_branches(Domains(**one), release, continuation)
    model = RestitutionModel(r)
    rigid = model.orbit_of(n, *restitution_orbits.branch(n, r, top, parameters.points))
    node, doubling = model.saddle_node(n), model.period_doubling(n)
    return describe(
        contact.assign(
            restitution_amplitude=("point", rigid.amplitude),
            restitution_phase=("point", rigid.phase),
            restitution_stable=("point", rigid.is_stable()),
            restitution_admissible=("point", rigid.is_admissible()),
            saddle_node_amplitude=((), float(node.amplitude)),
            saddle_node_phase=((), float(node.phase)),
            period_doubling_amplitude=((), float(doubling.amplitude)),
            period_doubling_phase=((), float(doubling.phase)),
        )
    )
