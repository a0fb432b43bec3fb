"""Existence and stability of n-T orbits by continuation along Λ (Figs. 8, 9 and 15, Table 1)."""

from typing import Annotated

import numpy as np
import xarray as xr
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches import observables
from bouncing_ball_beyond.periodic.branches.following import Followed, orbits_along
from bouncing_ball_beyond.periodic.branches.observables import (
    PLACE,
    columns,
    joined,
    n_t_columns,
    no_branch,
)
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact import restitution_branch as restitution_orbits
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    excess_angle,
    orbits_on_branch,
)
from bouncing_ball_beyond.periodic.one_impact.whole_branch import (
    NoBranch,
    branches_through,
    starts_of_branches,
    whole_branches,
)
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.saved import KEPT
from bouncing_ball_beyond.periodic.orbits.stability import Bifurcation

from bouncing_ball.datasets import LONG
from bouncing_ball.datasets.parameters import (
    Family,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    number,
)
from bouncing_ball.datasets.variables import SHARED, Variable, describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.branch import Branch, ContinuationError
from bouncing_ball.paper.exhibits.orbit_parameters import (
    BranchEnd,
    BranchPoints,
    BranchRatio,
    BranchRatios,
)
from bouncing_ball.paper.exhibits.printed_table1 import printed_table

VARIABLES = {
    "absence": Variable("why there is no stable range"),
    "restitution_admissible": Variable(
        "whether nothing else happens during the restitution model's orbit"
    ),
    "restitution_amplitude": Variable("excitation amplitude, restitution model", symbol="Λ"),
    "restitution_stable": Variable("whether the restitution model's orbit is stable"),
    "restitution_range": Variable("end of the stability range, restitution model", symbol="Λ"),
}
# The variables by which the orbits of a branch come back, which the figures do not need.
_OF_ORBITS = [*KEPT, "special_point", "digits_left"]
# The variables of branches are declared beside the function that writes them.
_VARIABLES = VARIABLES | observables.VARIABLES
_COMMON = ("point", "amplitude", "stable", "admissible", *observables.OBSERVED)
VARIABLES |= {
    f"{LONG}{name}": known._replace(long_name=f"{known.long_name}, branch from permanent contact")
    for name, known in (SHARED | observables.VARIABLES).items()
    if name in observables.VARIABLES or name in _COMMON
}
# The first flight of an orbit near permanent contact, in units of 1/ϖ: short against an oscillation
# of the contact, and long enough for the equations.
_SHORT_FLIGHT = 0.5
# Relative distance below which the end of a branch is at the largest Λ.
_AT_THE_TOP = 1e-9


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


class Ranges(Parameters):
    """Several families on several contacts, whose ranges of stability in Λ are computed."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: BranchEnd


def _branch(ratio: float, branch: Followed | NoBranch, parameters: Domains) -> xr.Dataset:
    """The branch of one contact; NaN, with the reason, where it cannot be followed."""
    points = parameters.points
    try:
        if not isinstance(branch, Followed):
            raise branch
        found = n_t_columns(branch.resampled(points))
    except (NoOrbitError, ContinuationError) as error:
        found = no_branch(points, error)
    shown = found.drop_vars(_OF_ORBITS, errors="ignore")
    return shown.assign_coords(frequency_ratio=ratio)


def orbit_branches(parameters: Domains, release: Release, continuation: Continuation) -> xr.Dataset:
    """Branches along Λ for one n and several ϖ (Figs. 8 and 9).

    The dataset has ``amplitude``, the observables of the orbits with phases in rad, ``stable``,
    ``admissible`` and ``residual`` (ϖ, point), at equal steps of arclength from the unstable to the
    stable side; ``multiplier_real`` and ``multiplier_imag`` (ϖ, point, multiplier);
    ``special_kind`` and further ``special_…`` variables of the saddle-nodes, period doublings and
    grazing orbits (ϖ, special); ``end_reason`` (ϖ, end), why the branch ends; and the number
    ``damping_ratio`` ζ. Where a branch cannot be followed its values are NaN and ``end_reason`` is
    the error.

    For n = 1 permanent contact continues into an orbit with a short flight. If its branch is
    another one, because the two are connected beyond ``amplitude_max`` only or not at all, the
    dataset has all of these variables a second time, with names that begin with ``long_``, and NaN
    on contacts on which this branch cannot be followed.

    Raises
    ------
    NoOrbitError
        If no branch can be followed on any of the contacts; the message is the first error.
    """
    branches = _branches(parameters, release, continuation)
    if not branches.amplitude.notnull().any():
        raise NoOrbitError(f"nothing to draw: {branches.end_reason.values[0, 0]}")
    return branches


def _branches(parameters: Domains, release: Release, continuation: Continuation) -> xr.Dataset:
    """The dataset of :func:`orbit_branches`, also if no branch can be followed."""
    branches, others = _first_and_second(parameters, release, continuation)
    zeta = float(damping_ratio(parameters.restitution))
    data = _labelled(branches, parameters).assign(damping_ratio=zeta)
    data = describe(data, variables=_VARIABLES)
    if not any(isinstance(other, Followed) for other in others):
        return data
    long = _in_turn_of_others(_labelled(others, parameters))
    names = [*long.data_vars, "point", "special"]
    long = long.rename({name: f"{LONG}{name}" for name in names})
    return data.merge(describe(long, variables=_VARIABLES | VARIABLES))


def _labelled(branches: list[Followed | NoBranch], parameters: Domains) -> xr.Dataset:
    """The branches of all contacts as one dataset."""
    pairs = zip(parameters.frequency_ratio, branches, strict=True)
    return joined([_branch(*pair, parameters) for pair in pairs], "frequency_ratio")


def _in_turn_of_others(long: xr.Dataset) -> xr.Dataset:
    """Second branches with phases at the end of contact near π/2, as on the first branches.

    The phases of a branch are continuous, and known up to a turn of the table.
    """
    turns = 2 * np.pi * np.round((long.release_phase.mean("point") - np.pi / 2) / (2 * np.pi))
    phases = ("phase", "release_phase", "special_phase")
    return long.assign({name: long[name] - turns for name in phases})


def _first_and_second(
    parameters: Domains, release: Release, continuation: Continuation
) -> tuple[list[Followed | NoBranch], list[Followed | NoBranch]]:
    """The branch of each contact, from the unstable to the stable side, and the one that begins at
    permanent contact, with errors in place of those that cannot be followed.

    There is no second one on most contacts of the force release, for n > 1, and where both are the
    same. All are followed side by side.
    """
    n = parameters.n
    top = parameters.amplitude_max
    ratios = np.array(parameters.frequency_ratio)
    contacts = SpringDamper.from_restitution(parameters.restitution, ratios, release)
    families = np.full(ratios.size, n)
    starts = starts_of_branches(ContactModel(contacts), families, top)
    duration = 2 * np.pi * n - _SHORT_FLIGHT / ratios
    long = orbits_on_branch(excess_angle(contacts, duration), contacts, n)
    rows = np.flatnonzero(long.exists & (long.amplitude < top) & long.is_admissible())
    place = ("amplitude", "phase", "contact_duration", "impact_velocity")
    both = {
        name: np.concatenate([getattr(starts, name), getattr(long, name)[rows]]) for name in place
    }
    model = ContactModel(contacts[[*range(ratios.size), *rows]])
    found = branches_through(Orbit.of(model, n, **both), top, continuation.largest_step)
    branches = found[: ratios.size]
    none = NoOrbitError("no other branch begins at permanent contact")
    others: list[Followed | NoBranch] = [none] * ratios.size
    for row, other in zip(rows, found[ratios.size :], strict=True):
        if not _ends_at_permanent_contact(branches[row], top):
            others[row] = other
    return branches, others


def _ends_at_permanent_contact(branch: Followed | NoBranch, top: float) -> bool:
    """Whether a branch ends elsewhere than at the largest Λ, of a contact on which a branch begins
    at permanent contact.
    """
    if not isinstance(branch, Followed):
        return False
    ends = orbits_along(branch.problem, branch.branch.points[[0, -1]]).amplitude
    return not np.all(ends > top * (1 - _AT_THE_TOP))


class BothDomains(Branches):
    """One family, followed along Λ on one contact and in the restitution model."""

    frequency_ratio: BranchRatio


def both_domains(
    parameters: BothDomains, release: Release, continuation: Continuation
) -> xr.Dataset:
    """The branch of one ϖ, and that of the restitution model (Fig. 15).

    The dataset has the variables of :func:`orbit_branches` with one ϖ. The
    restitution model has ``restitution_amplitude``, ``restitution_phase`` in rad,
    ``restitution_stable`` and ``restitution_admissible`` (point,), and numbers for Λ and φ of its
    two bifurcations.

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit up to ``amplitude_max``.
    """
    n = parameters.n
    r = parameters.restitution
    top = parameters.amplitude_max
    one = dict(parameters) | {"frequency_ratio": (parameters.frequency_ratio,)}
    contact = _branches(Domains(**one), release, continuation)
    model = RestitutionModel(r)
    rigid = Orbit.of(model, n, *restitution_orbits.branch_points(n, r, top, parameters.points))
    along = columns(rigid, "amplitude", "phase")
    fold = n_t.saddle_node(model, n)
    doubling = n_t.period_doubling(model, n)
    both = contact.assign(
        {f"restitution_{name}": ("point", values) for name, values in along.items()}
    ).assign(
        saddle_node_amplitude=fold.amplitude,
        saddle_node_phase=fold.phase,
        period_doubling_amplitude=doubling.amplitude,
        period_doubling_phase=doubling.phase,
    )
    return describe(both, variables=_VARIABLES)


def first_limits(branch: Branch) -> np.ndarray:
    """The saddle-node and the period doubling that bound the first stable range, shape (2, N + 1).

    In the order of the branch, from the unstable to the stable side, they are its last saddle-node
    and the first period doubling after it.

    Raises
    ------
    NoOrbitError
        If the branch lacks one of them.
    """
    folds = [
        k for k, special in enumerate(branch.special) if special.name == Bifurcation.SADDLE_NODE
    ]
    beyond = branch.special[folds[-1] :] if folds else ()
    flips = [special for special in beyond if special.name == Bifurcation.PERIOD_DOUBLING]
    if not flips:
        missing = Bifurcation.PERIOD_DOUBLING if folds else Bifurcation.SADDLE_NODE
        raise NoOrbitError(
            f"the branch from {str(branch.start)!r} to {str(branch.end)!r} has no {missing} to "
            "bound its stable range"
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
    families = np.array(parameters.n)
    ratios = np.array(parameters.frequency_ratio)
    shape = (ratios.size, families.size)
    contacts = SpringDamper.from_restitution(
        parameters.restitution, np.repeat(ratios, families.size), release
    )
    branches = whole_branches(
        ContactModel(contacts),
        np.tile(families, ratios.size),
        parameters.amplitude_max,
        continuation.largest_step,
        ends=list(Bifurcation),
    )
    found = np.full((*shape, len(Bifurcation), len(PLACE)), np.nan)
    absence = np.full(shape, "", dtype=object)
    for at, branch in zip(np.ndindex(shape), branches, strict=True):
        try:
            found[at] = _stability_range(branch)
        except (NoOrbitError, ContinuationError) as error:
            absence[at] = str(error)
    maps = list(restitution_orbits.ImpactMap)
    dims = ("frequency_ratio", "n", "bound")
    dataset = xr.Dataset(
        {
            "computed": (dims, found[..., PLACE.index("amplitude")]),
            "special_phase": (dims, found[..., PLACE.index("phase")]),
            "special_contact_duration": (dims, found[..., PLACE.index("contact_duration")]),
            # Entries that the paper does not have become NaN.
            "printed": printed_table().reindex(frequency_ratio=ratios, n=families),
            "restitution_range": (
                ("impact_map", "n", "bound"),
                _restitution_ranges(families, parameters.restitution, maps),
            ),
        },
        coords={
            "frequency_ratio": ratios,
            "n": families,
            "bound": list(Bifurcation),
            "impact_map": [str(kind) for kind in maps],
        },
    )
    if np.any(absence != ""):
        dataset["absence"] = (("frequency_ratio", "n"), absence.astype(str))
    return describe(dataset, variables=_VARIABLES)


def _stability_range(branch: Followed | NoBranch) -> np.ndarray:
    """Λ, φ and τ_b of both ends of a stability range, shape (bound, 3).

    Raises
    ------
    NoOrbitError, ContinuationError
        If the branch is such an error, or as of :func:`first_limits`.
    """
    if not isinstance(branch, Followed):
        raise branch
    limits = orbits_along(branch.problem, first_limits(branch.branch))
    return np.stack([getattr(limits, name) for name in PLACE], axis=-1)


def _restitution_ranges(
    n: np.ndarray, restitution: float, maps: list[restitution_orbits.ImpactMap]
) -> np.ndarray:
    """The stability ranges of the restitution model, shape (map, n, bound)."""
    fold = n_t.saddle_node(RestitutionModel(restitution), n).amplitude
    doublings = [restitution_orbits.period_doubling(n, restitution, kind) for kind in maps]
    return np.array([np.stack([fold, doubling], axis=-1) for doubling in doublings])
