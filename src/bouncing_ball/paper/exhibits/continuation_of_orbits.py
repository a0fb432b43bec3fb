"""Existence and stability of n-T orbits by continuation along Λ (Figs. 8, 9 and 15, Table 1)."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import (
    Family,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    number,
)
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.numerics.branch import ContinuationError
from bouncing_ball.paper.exhibits.orbit_parameters import (
    BranchEnd,
    BranchPoints,
    BranchRatio,
    BranchRatios,
)
from bouncing_ball.paper.exhibits.printed_table1 import printed_table
from bouncing_ball.periodic import branches
from bouncing_ball.periodic.branches import PLACE, branch_dataset, joined, no_branch
from bouncing_ball.periodic.continuation import NoBranch, OrbitBranch, follow_branches
from bouncing_ball.periodic.orbit import Bifurcation
from bouncing_ball.periodic.restitution_branch import (
    ImpactMap,
    RestitutionBranch,
    restitution_period_doubling,
    restitution_saddle_node,
)

VARIABLES = {
    "absence": Variable("why there is no stable range"),
    "restitution_admissible": Variable(
        "whether nothing else happens during the restitution model's orbit"
    ),
    "restitution_amplitude": Variable("excitation amplitude, restitution model", symbol="Λ"),
    "restitution_stable": Variable("whether the restitution model's orbit is stable"),
    "restitution_range": Variable("end of the stability range, restitution model", symbol="Λ"),
}
# The variables of branches are declared beside the function that writes them.
_VARIABLES = VARIABLES | branches.VARIABLES


class Continuation(Parameters):
    """Settings of the continuation for the whole run."""

    largest_step: Annotated[
        float,
        number(
            "largest step in arclength; a longer one may pass two bifurcations", ge=0.02, le=0.5
        ),
    ]


class Branches(Parameters):
    """One family of orbits, which is followed along Λ."""

    n: Family
    restitution: LossyRestitution
    amplitude_max: BranchEnd
    points: BranchPoints


class Domains(Branches):
    """One family, followed along Λ on several contacts."""

    frequency_ratio: BranchRatios


class BothDomains(Branches):
    """One family, followed along Λ on one contact and in the restitution model."""

    frequency_ratio: BranchRatio


class Ranges(Parameters):
    """Several families on several contacts, whose ranges of stability in Λ are computed."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: BranchEnd


def orbit_branches(parameters: Domains, release: Release, continuation: Continuation) -> xr.Dataset:
    """Branches along Λ for one n and several ϖ (Figs. 8 and 9).

    The dataset has ``amplitude``, the observables of the orbits with phases in rad, ``stable``,
    ``admissible`` and ``residual`` (ϖ, point), at equal steps of arclength from the unstable to the
    stable side; ``multiplier_real`` and ``multiplier_imag`` (ϖ, point, multiplier);
    ``special_kind`` and further ``special_…`` variables of the saddle-nodes, period doublings and
    grazing orbits (ϖ, special); ``end_reason`` (ϖ, end), why the branch ends; and the number
    ``damping_ratio`` ζ. Where a branch cannot be followed its values are NaN and ``end_reason`` is
    the error.

    Raises
    ------
    NoOrbitError
        If no branch can be followed on any of the contacts; the message is the first error.
    """
    found = _branches(parameters, parameters.frequency_ratio, release, continuation)
    if not found.amplitude.notnull().any():
        raise NoOrbitError(f"nothing to draw: {found.end_reason.values[0, 0]}")
    return found


def _branches(
    parameters: Branches, ratios: tuple[float, ...], release: Release, continuation: Continuation
) -> xr.Dataset:
    """The dataset of :func:`orbit_branches`, also if no branch can be followed."""
    contacts = SpringDamper.from_restitution(parameters.restitution, ratios, release)
    families = np.full(len(ratios), parameters.n)
    found = follow_branches(contacts, families, parameters.amplitude_max, continuation.largest_step)
    data = joined([_columns(each, parameters.points) for each in found], "frequency_ratio")
    data = data.assign_coords(frequency_ratio=list(ratios))
    data["damping_ratio"] = float(damping_ratio(parameters.restitution))
    return describe(data, _VARIABLES)


def _columns(found: OrbitBranch | NoBranch, points: int) -> xr.Dataset:
    """The branch of one contact; NaN, with the reason, where it cannot be followed."""
    try:
        if not isinstance(found, OrbitBranch):
            raise found
        return branch_dataset(found, points)
    except (NoOrbitError, ContinuationError) as error:
        return no_branch(points, error)


def both_domains(
    parameters: BothDomains, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one ϖ, and that of the restitution model (Fig. 15).

    The dataset has the variables of :func:`orbit_branches` with one ϖ. The restitution model has
    ``restitution_amplitude``, ``restitution_phase`` in rad, ``restitution_stable`` and
    ``restitution_admissible`` (point,), and numbers for Λ and φ of its two bifurcations.

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit up to ``amplitude_max``.
    """
    n = parameters.n
    data = _branches(parameters, (parameters.frequency_ratio,), release, continuation)
    branch = RestitutionBranch(RestitutionModel(parameters.restitution))
    rigid = branch.along(n, parameters.amplitude_max, parameters.points)
    for name in ("amplitude", "phase", "stable", "admissible"):
        data[f"restitution_{name}"] = "point", getattr(rigid, name)
    for kind in Bifurcation:
        limit = branch.bifurcation(kind, n)
        data[f"{kind.name.lower()}_amplitude"] = float(limit.amplitude)
        data[f"{kind.name.lower()}_phase"] = float(limit.phase)
    return describe(data, _VARIABLES)


def stability_ranges(
    parameters: Ranges, release: Release, continuation: Continuation
) -> xr.Dataset:
    """Ranges of Λ in which the n-T orbits are stable, computed and printed (Table 1).

    The dataset has ``computed`` and ``printed``, values of Λ, ``special_phase`` in rad and
    ``special_contact_duration``, shape (ϖ, n, bound), where the bounds are a saddle-node and a
    period doubling; and ``restitution_range`` (impact_map, n, bound). An entry is NaN where the
    orbit has no such range, and ``absence`` (ϖ, n), which exists only then, says why; ``printed``
    is NaN where the paper has no entry.
    """
    families = np.array(parameters.n)
    ratios = np.array(parameters.frequency_ratio)
    shape = (ratios.size, families.size)
    r = parameters.restitution
    found = follow_branches(
        SpringDamper.from_restitution(r, np.repeat(ratios, families.size), release),
        np.tile(families, ratios.size),
        parameters.amplitude_max,
        continuation.largest_step,
        ends=list(Bifurcation),
    )
    places = np.full((*shape, len(Bifurcation), len(PLACE)), np.nan)
    absence = np.full(shape, "", dtype=object)
    for at, branch in zip(np.ndindex(shape), found, strict=True):
        try:
            places[at] = _stability_range(branch)
        except (NoOrbitError, ContinuationError) as error:
            absence[at] = str(error)
    fold = restitution_saddle_node(families, r)
    doublings = [restitution_period_doubling(families, r, kind) for kind in ImpactMap]
    dims = ("frequency_ratio", "n", "bound")
    dataset = xr.Dataset(
        {
            "computed": (dims, places[..., PLACE.index("amplitude")]),
            "special_phase": (dims, places[..., PLACE.index("phase")]),
            "special_contact_duration": (dims, places[..., PLACE.index("contact_duration")]),
            # Entries that the paper does not have become NaN.
            "printed": printed_table().reindex(frequency_ratio=ratios, n=families),
            "restitution_range": (
                ("impact_map", "n", "bound"),
                [np.stack([fold, each], axis=-1) for each in doublings],
            ),
        },
        coords={
            "frequency_ratio": ratios,
            "n": families,
            "bound": list(Bifurcation),
            "impact_map": [str(kind) for kind in ImpactMap],
        },
    )
    if np.any(absence != ""):
        dataset["absence"] = (("frequency_ratio", "n"), absence.astype(str))
    return describe(dataset, variables=_VARIABLES)


def _stability_range(found: OrbitBranch | NoBranch) -> np.ndarray:
    """Λ, φ and τ_b of the saddle-node and of the period doubling that bound the first stable range,
    shape (bound, 3).

    In the order of the branch, from the unstable to the stable side, they are its last saddle-node
    and the first period doubling after it.

    Raises
    ------
    NoOrbitError, ContinuationError
        If the branch is such an error, or lacks one of the bifurcations.
    """
    if not isinstance(found, OrbitBranch):
        raise found
    special = found.special
    folds = [k for k, each in enumerate(special) if each.name == Bifurcation.SADDLE_NODE]
    beyond = special[folds[-1] :] if folds else []
    flips = [each for each in beyond if each.name == Bifurcation.PERIOD_DOUBLING]
    if not flips:
        missing = Bifurcation.PERIOD_DOUBLING if folds else Bifurcation.SADDLE_NODE
        ends = found.branch
        raise NoOrbitError(
            f"the branch from {str(ends.start)!r} to {str(ends.end)!r} has no {missing} to "
            "bound its stable range"
        )
    limits = found.equations.orbit(np.array([beyond[0].point, flips[0].point]))
    return np.stack([getattr(limits, name) for name in PLACE], axis=-1)
