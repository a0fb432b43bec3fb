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
from bouncing_ball.numerics.continuation import Branch, ContinuationError
from bouncing_ball.paper.contact.damping import Release, damping_ratio
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.orbit_parameters import BranchEnd, Points
from bouncing_ball.paper.exhibits.printed_table1 import printed_table
from bouncing_ball.paper.orbits import restitution_branch as restitution_orbits
from bouncing_ball.paper.orbits.branch import whole_branch
from bouncing_ball.paper.orbits.equations import OrbitSystem
from bouncing_ball.paper.orbits.observables import PLACE, branch_columns, columns, joined, no_branch
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.paper.orbits.stability import Bifurcation

VARIABLES = {
    "restitution_admissible": Variable(
        "whether nothing else happens during the restitution model's orbit"
    ),
    "restitution_amplitude": Variable("excitation amplitude, restitution model", symbol="Λ"),
    "restitution_stable": Variable("whether the restitution model's orbit is stable"),
    "restitution_range": Variable("end of the stability range, restitution model", symbol="Λ"),
}


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
    points: Points


class Domains(Branches):
    """One family, followed along Λ on several contacts."""

    frequency_ratio: Many[FrequencyRatio]


class Ranges(Parameters):
    """Several families on several contacts, whose ranges of stability in Λ are computed."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: BranchEnd


def followed(
    n: int, ratio: float, given: Branches, release: Release, continuation: Continuation
) -> tuple[OrbitSystem, Branch]:
    """The equations of one contact, and their solutions from the unstable to the stable side.

    Raises
    ------
    NoOrbitError, ContinuationError
        As :func:`~bouncing_ball.paper.orbits.branch.whole_branch`.
    """
    model = SpringDamperModel(SpringDamper.from_restitution(given.restitution, ratio, release))
    found = whole_branch(model, n, given.amplitude_max, continuation.largest_step)
    return model.system(n), found


def _branch(
    ratio: float, parameters: Branches, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one contact; NaN, with the reason, where it cannot be followed."""
    try:
        branch = followed(parameters.n, ratio, parameters, release, continuation)
        found = branch_columns(*branch, parameters.points)
    except (NoOrbitError, ContinuationError) as error:
        found = no_branch(parameters.points, error)
    return found.assign_coords(frequency_ratio=ratio)


def orbit_branches(parameters: Domains, release: Release, continuation: Continuation) -> xr.Dataset:
    """Branches along Λ for one n and several ϖ (Figs. 8 and 9).

    The dataset has the number ``damping_ratio`` ζ;
    ``amplitude``, the observables of the orbits with phases in rad, ``stable``,
    ``admissible`` and ``residual`` (ϖ, point), at equal steps of arclength from the unstable to the
    stable side; ``multiplier_real`` and ``multiplier_imag`` (ϖ, point, multiplier);
    ``special_kind`` and further ``special_…`` variables of the saddle-nodes, period doublings and
    grazing orbits (ϖ, special); and ``end_reason`` (ϖ, end), why the branch ends. Where a branch
    cannot be followed its values are NaN and ``end_reason`` is the error.
    """
    ratios = parameters.frequency_ratio
    rows = [_branch(ratio, parameters, release, continuation) for ratio in ratios]
    zeta = float(damping_ratio(parameters.restitution))
    branches = joined(rows, "frequency_ratio").assign(damping_ratio=zeta)
    return describe(branches, variables=VARIABLES)


SADDLE_NODE, PERIOD_DOUBLING = Bifurcation


class BothDomains(Branches):
    """One family, followed along Λ on one contact and in the restitution model."""

    frequency_ratio: FrequencyRatio


def both_domains(
    parameters: BothDomains, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one ϖ, and that of the restitution model (Fig. 15).

    The dataset has the variables of :func:`~.orbit_branches.orbit_branches` with one ϖ. The
    restitution model has ``restitution_amplitude``, ``restitution_phase`` in rad,
    ``restitution_stable`` and ``restitution_admissible`` (point,), and numbers for Λ and φ of its
    two bifurcations.

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
    along = columns(rigid, "amplitude", "phase")
    limits = {"saddle_node": model.saddle_node(n), "period_doubling": model.period_doubling(n)}
    return describe(
        contact.assign(
            {f"restitution_{name}": ("point", values) for name, values in along.items()}
            | {f"{kind}_{x}": getattr(limits[kind], x) for kind in limits for x in PLACE[:2]}
        ),
        variables=VARIABLES,
    )


def first_limits(branch: Branch) -> np.ndarray:
    """The saddle-node and the period doubling that bound the first stable range, shape (2, N + 1).

    In the order of the branch, from the unstable to the stable side, they are its last saddle-node
    and the first period doubling after it.

    Raises
    ------
    NoOrbitError
        If the branch lacks one of them.
    """
    folds = [k for k, special in enumerate(branch.special) if special.name == SADDLE_NODE]
    beyond = branch.special[folds[-1] :] if folds else ()
    flips = [special for special in beyond if special.name == PERIOD_DOUBLING]
    if not flips:
        raise NoOrbitError(
            f"the branch from {str(branch.start)!r} to {str(branch.end)!r} has no "
            f"{PERIOD_DOUBLING if folds else SADDLE_NODE} to bound its stable range"
        )
    return np.array([beyond[0].point, flips[0].point])


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
    families, ratios = parameters.n, parameters.frequency_ratio
    shape = len(ratios), len(families)
    found, absence = np.full((*shape, 2, len(PLACE)), np.nan), np.full(shape, "", dtype=object)
    for at in np.ndindex(shape):
        n, ratio = families[at[1]], ratios[at[0]]
        try:
            contact = SpringDamper.from_restitution(parameters.restitution, ratio, release)
            model, step = SpringDamperModel(contact), continuation.largest_step
            branch = whole_branch(model, n, parameters.amplitude_max, step, Bifurcation)
            limits = model.system(n).orbit(first_limits(branch))
            found[at] = np.stack([getattr(limits, name) for name in PLACE], axis=-1)
        except (NoOrbitError, ContinuationError) as error:
            absence[at] = str(error)
    r, maps = parameters.restitution, restitution_orbits.ImpactMap
    rigid = RestitutionModel(r).saddle_node(np.array(families))
    doublings = [restitution_orbits.period_doubling(np.array(families), r, kind) for kind in maps]
    rigid_ranges = np.array([np.stack([rigid.amplitude, each], axis=-1) for each in doublings])
    dims = ("frequency_ratio", "n", "bound")
    names = ("computed", "special_phase", "special_contact_duration")
    dataset = xr.Dataset(
        {
            **{name: (dims, found[..., k]) for k, name in enumerate(names)},
            # Entries that the paper does not have become NaN.
            "printed": printed_table().reindex(frequency_ratio=list(ratios), n=list(families)),
            "restitution_range": (("impact_map", "n", "bound"), rigid_ranges),
        },
        coords={
            "frequency_ratio": np.array(ratios),
            "n": np.array(families),
            "bound": [SADDLE_NODE, PERIOD_DOUBLING],
            "impact_map": [str(kind) for kind in maps],
        },
    )
    if np.any(absence != ""):
        dataset["absence"] = (dims[:2], absence.astype(str))
    return describe(dataset, variables=VARIABLES)
