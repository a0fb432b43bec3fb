"""TODO docstring of paper.orbits.observables."""

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.numerics.continuation import Branch, resample
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits.equations import OrbitSystem
from bouncing_ball.paper.orbits.orbit import Orbit
from bouncing_ball.paper.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.paper.orbits.stability import Bifurcation

OBSERVED = (
    *("phase", "contact_duration", "release_phase"),
    *("impact_velocity", "bounce_velocity", "apparent_restitution"),
)
PLACE = ("amplitude", "phase", "contact_duration")
"""The quantities of special orbits that the datasets contain."""

GRAZING = "grazing"


def columns(orbit: Orbit, *names: str) -> dict[str, np.ndarray]:
    """The named quantities of orbits, with the stability and the admissibility of the orbits.

    Every array has the shape of the orbits.

    Examples
    --------
    >>> from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
    >>> found = columns(RestitutionModel(1.0).orbit(1, 0.5), "phase")
    >>> {name: value.item() for name, value in found.items()}
    {'phase': 1.5707963267948966, 'stable': False, 'admissible': True}
    """
    judged = {"stable": orbit.is_stable(), "admissible": orbit.is_admissible()}
    return {name: getattr(orbit, name) for name in names} | judged


def branch_columns(system: OrbitSystem, branch: Branch, count: int) -> xr.Dataset:
    """A branch at ``count`` points with equal steps of arclength, and its special orbits.

    The variables are those of :func:`orbits_in_columns`; grazing orbits are found between the
    points.

    Raises
    ------
    ContinuationError
        If the steps along the branch were too long for it to be resampled.
    """
    y = resample(system, branch, count)
    chosen = [s for s in branch.special if s.name in list(Bifurcation)]
    grazing = system.grazing(y)
    points = np.array([*(s.point for s in chosen), *grazing]).reshape(-1, y.shape[-1])
    kinds = [*(str(s.name) for s in chosen), *[GRAZING] * len(grazing)]
    ends = [str(branch.start), str(branch.end)]
    return orbits_in_columns(system.orbit(y), system.orbit(points), kinds, ends)


def orbits_in_columns(
    orbit: Orbit, special: Orbit, kinds: list[str], ends: list[str]
) -> xr.Dataset:
    """Orbits along a branch, its special orbits with their kinds, and the reasons for its two ends.

    Over ``point``, the dataset has the observables of the orbits, with phases in rad, and
    ``amplitude``, ``stable``, ``admissible`` and ``residual``. The multipliers are over (point,
    multiplier), ``special_…`` over ``special``, and ``end_reason`` over ``end``, where the end of
    the unstable side comes first.
    """
    floquet = orbit.multipliers()
    along = columns(orbit, "amplitude", *OBSERVED) | {"residual": orbit.defect()}
    places = {name: getattr(special, name) for name in PLACE} | {"residual": special.defect()}
    data: dict[str, Any] = {name: ("point", values) for name, values in along.items()}
    for part in ("real", "imag"):
        data[f"multiplier_{part}"] = ("point", "multiplier"), getattr(floquet, part)
    data["special_kind"] = "special", np.array(kinds, dtype=object)
    data |= {f"special_{name}": ("special", values) for name, values in places.items()}
    # Numbers, so that branches with different numbers of special points are aligned.
    coords = {"special": np.arange(len(kinds)), "end": ["unstable side", "stable side"]}
    return xr.Dataset(data | {"end_reason": ("end", ends)}, coords)


def no_branch(count: int, error: Exception) -> xr.Dataset:
    """A dataset like that of :func:`branch_columns`, of NaN, with the error as its end reasons."""
    system = OrbitSystem(1, SpringDamper(1.0, 0.0), SpringDamperOrbit.at)
    none = system.orbit(np.full((count, 4), np.nan))
    return orbits_in_columns(none, none[:0], [], [str(error)] * 2)


def joined(branches: list[xr.Dataset], dim: str) -> xr.Dataset:
    """Branches along a new dimension; those with fewer special orbits are filled with NaN."""
    whole = xr.concat(branches, dim, join="outer")
    return whole.assign(special_kind=whole.special_kind.fillna("").astype(str))
