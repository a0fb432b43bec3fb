"""Branches of n-T orbits over Λ with their special orbits, as datasets; the call ``branch``.

The variables of a branch are the observables along it, over the dimension ``point``, and the place
of each special orbit, over ``special``: its bifurcations, and the grazing orbits, at which the
orbits become inadmissible.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball_beyond.inherited.datasets.arguments import (
    FAMILY,
    POINTS,
    POSITIVE,
    FamilyAxis,
    Points,
    Positive,
    checked,
    checked_number,
    require_memory,
)
from bouncing_ball_beyond.inherited.datasets.labelled import CASE, Grid
from bouncing_ball_beyond.inherited.datasets.variables import Variable, describe
from bouncing_ball_beyond.inherited.drawing.result import Result
from bouncing_ball_beyond.inherited.errors import NoOrbitError, suggesting
from bouncing_ball_beyond.inherited.models.model import Model, a_ball
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError
from bouncing_ball_beyond.inherited.periodic.continuation import (
    LARGEST_STEP,
    OrbitBranch,
    Special,
    default_top,
    follow_branches,
)
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Orbit, defect, multipliers
from bouncing_ball_beyond.inherited.periodic.restitution_branch import RestitutionBranch

VARIABLES = {
    "special": Variable("special point of the branch, in order of arclength"),
    "special_kind": Variable("kind of special point"),
    "special_amplitude": Variable("excitation amplitude at the special point", symbol="Λ"),
    "special_phase": Variable(
        "phase at the special point", symbol="φ", units="rad", equation="Eq. 21"
    ),
    "special_contact_duration": Variable(
        "contact duration at the special point", symbol="τ_b", equation="Eq. 23", budget=1e-12
    ),
    "special_arclength": Variable(
        "arclength of the branch up to the special point, over that of the whole branch",
        budget=1e-4,
        scale="1",
    ),
    "special_residual": Variable(
        "residual of the extended system at the special point", budget=1e-12, scale="1"
    ),
    "multiplier": Variable("Floquet multiplier, the larger modulus first", symbol="μ"),
    "multiplier_real": Variable("real part of the Floquet multiplier", symbol="Re μ"),
    "multiplier_imag": Variable("imaginary part of the Floquet multiplier", symbol="Im μ"),
    "residual": Variable(
        "largest defect of the orbit equations", equation="Eqs. 21-26", budget=1e-12, scale="1"
    ),
    "end": Variable("end of the branch"),
    "end_reason": Variable("why the branch ends there"),
}

OBSERVED = (
    "phase",
    "contact_duration",
    "release_phase",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
)
"""The quantities of orbits along a branch or along ϖ."""

PLACE = ("amplitude", "phase", "contact_duration")
"""The quantities of special orbits that the datasets contain."""

_ENDS = ["unstable side", "stable side"]
# The longest step along a branch is this fraction of the largest Λ, if that is large: a branch has
# some thousand points at most.
_STRIDE = 2e-3
# Samples of a branch of the restitution model, among which points at equal steps are interpolated.
_FINE = 20_001


class _Points(NamedTuple):
    """Orbits along a branch, or its special orbits in order, as rows: their coordinates
    (φ, z′_i, ϖτ_b, Λ), or (φ, Λ) of the restitution model, and the largest defects of their
    equations.
    """

    orbits: Orbit
    coordinates: np.ndarray
    residual: np.ndarray


def branch_dataset(branch: OrbitBranch, count: int) -> xr.Dataset:
    """A branch of the spring-damper model at ``count`` points with equal steps of arclength.

    Over ``point`` it has ``amplitude``, the observables of the orbits, ``stable``, ``admissible``
    and ``residual``, and over (point, multiplier) the multipliers. The variables ``special_…`` are
    over ``special``, and ``end_reason`` is over ``end``.

    Raises
    ------
    ContinuationError
        If the steps along the branch were too long for it.
    """
    equations = branch.equations
    special = branch.special

    def points(y: np.ndarray) -> _Points:
        orbits = equations.orbit(y)
        defect = np.max(np.abs(equations.residual(y)), axis=-1)
        return _Points(orbits, branch.measured(y), defect)

    y = np.array([each.point for each in special]).reshape(len(special), 7)
    kinds = [str(each.name) for each in special]
    ends = [str(branch.branch.start), str(branch.branch.end)]
    return _dataset(points(branch.at_equal_steps(count)), kinds, points(y), ends)


def restitution_dataset(
    model: RestitutionModel, n: int, amplitude_max: float, count: int
) -> xr.Dataset:
    """A branch of the restitution model, with the variables of :func:`branch_dataset`.

    Raises
    ------
    NoOrbitError
        If ``amplitude_max`` lies below the saddle-node.
    """
    branch = RestitutionBranch(model)

    def points(orbits: Orbit) -> _Points:
        place = (orbits.phase, orbits.amplitude)
        return _Points(orbits, np.stack(place, axis=-1), defect(orbits))

    fine = branch.along(n, amplitude_max, _FINE)
    passed = np.cumsum(np.hypot(np.diff(fine.phase), np.diff(fine.amplitude)))
    passed = np.concatenate([[0.0], passed])
    wanted = np.linspace(0.0, passed[-1], count)
    lifts = np.interp(wanted, passed, fine.amplitude * np.sin(fine.phase))
    found = {
        Special.GRAZING_FLIGHT: branch.grazing(n, amplitude_max),
        Special.SADDLE_NODE: branch.bifurcation(Bifurcation.SADDLE_NODE, n),
        Special.PERIOD_DOUBLING: branch.bifurcation(Bifurcation.PERIOD_DOUBLING, n),
    }
    # In the order of the branch, along which φ increases.
    there = {kind: each for kind, each in found.items() if each.amplitude <= amplitude_max}
    special = branch.at(n, np.array([x.amplitude * np.sin(x.phase) for x in there.values()]))
    ends = [f"amplitude = {amplitude_max:g} is reached"] * 2
    kinds = [str(kind) for kind in there]
    return _dataset(points(branch.at(n, lifts)), kinds, points(special), ends)


def no_branch(count: int, error: Exception) -> xr.Dataset:
    """A dataset like that of :func:`branch_dataset`, of NaN, with the error as its end reasons."""
    none = np.full(count, np.nan)
    orbits = Orbit(RestitutionModel(1.0), 1, none, none, none, none)
    nowhere = _Points(orbits, np.zeros((count, 1)), none)
    nothing = _Points(orbits[:0], np.zeros((0, 1)), none[:0])
    return _dataset(nowhere, [], nothing, [str(error)] * 2)


def _dataset(
    along: _Points, kinds: Sequence[str], special: _Points, ends: Sequence[str]
) -> xr.Dataset:
    orbits = along.orbits
    floquet = multipliers(orbits)
    data: dict[str, Any] = {
        "amplitude": ("point", orbits.amplitude),
        **{name: ("point", getattr(orbits, name)) for name in OBSERVED},
        "stable": ("point", orbits.stable),
        "admissible": ("point", orbits.admissible),
        "residual": ("point", along.residual),
        "multiplier_real": (("point", "multiplier"), floquet.real),
        "multiplier_imag": (("point", "multiplier"), floquet.imag),
        **{f"special_{name}": ("special", getattr(special.orbits, name)) for name in PLACE},
        "special_kind": ("special", np.array(kinds, dtype=object)),
        "special_arclength": ("special", _arclength(special.coordinates, along.coordinates)),
        "special_residual": ("special", special.residual),
        "end_reason": ("end", list(ends)),
    }
    # Numbers, so that branches with different numbers of special points are aligned.
    return xr.Dataset(data, {"special": np.arange(len(kinds)), "end": _ENDS})


def _arclength(special: np.ndarray, along: np.ndarray) -> np.ndarray:
    """The arclength up to points beside a branch over that of the whole branch.

    A point lies between the two neighbours to which it makes the smallest detour.

    Examples
    --------
    >>> along = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    >>> _arclength(np.array([[0.5, 0.0], [1.0, 1.0]]), along).tolist()
    [0.25, 1.0]
    """
    if not len(special):
        return np.zeros(0)
    distance = np.linalg.norm(special[:, np.newaxis] - along, axis=-1)
    step = np.linalg.norm(np.diff(along, axis=0), axis=-1)
    before = np.argmin(distance[:, :-1] + distance[:, 1:] - step, axis=-1)
    row = np.arange(len(special))
    behind = distance[row, before]
    passed = np.concatenate([[0.0], np.cumsum(step)])
    share = behind / (behind + distance[row, before + 1])
    return (passed[before] + step[before] * share) / passed[-1]


def joined(branches: Sequence[xr.Dataset], dim: str) -> xr.Dataset:
    """Branches along a new dimension; those with fewer special orbits are filled with NaN."""
    whole = xr.concat(branches, dim, join="outer")
    return whole.assign(special_kind=whole.special_kind.fillna("").astype(str))


@suggesting
def branch(
    ball: Model, n: FamilyAxis = 1, *, amplitude_max: Positive | None = None, points: Points = 300
) -> Result:
    """The branch of n-T orbits over the amplitude Λ, on both sides of its saddle-node.

    Parameters
    ----------
    ball : Model
    n : int or array of int
        Index n of the family.
    amplitude_max : float, optional
        Largest Λ of the branch; by default 1.4 times that of the period doubling.
    points : int
        Number of points along the branch, at equal steps of arclength.

    Returns
    -------
    Result
        ``amplitude``, ``phase`` and the other observables of each ``point``, and whether the
        orbit is ``stable`` and ``admissible``; ``special_amplitude`` and others of the
        saddle-nodes, period doublings and grazing orbits. Where one of several branches does not
        exist it is NaN, and ``end_reason`` says why.

    Raises
    ------
    NoOrbitError
        If there is no branch up to this Λ, or if it cannot be followed.
    ModelError
        If a parameter is of a wrong type or shape, or out of range.

    Examples
    --------
    >>> import math
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = branch(rigid(restitution=0.85), points=50)
    >>> found.special_kind.values.tolist()
    ['saddle-node', 'period doubling']
    >>> round(float(found.special_amplitude[0]) / math.pi * 1.85 / 0.15, 12)
    1.0
    """
    grid, top, count = checked_branches(a_ball(ball).parameters, n, amplitude_max, points)
    balls = ball.row(grid)
    rows = []
    for k, place in enumerate(grid.cells()):
        try:
            rows.append(_branch_of(balls.take(k), place["n"], top, count))
        except NoOrbitError as error:
            if not grid.shape:
                raise
            rows.append(no_branch(count, error))
    data = grid.unfold(describe(joined(rows, CASE), VARIABLES))
    known = {} if top is None else {"amplitude_max": top}
    return Result.of(data.assign_attrs(known), "branch")


def checked_branches(
    parameters: Mapping[str, Any], n: FamilyAxis, amplitude_max: Positive | None, points: Points
) -> tuple[Grid, float | None, int]:
    """The grid of n and of the parameters of a ball, the largest Λ, and the number of points.

    Raises
    ------
    ModelError
        If an argument is of a wrong type or shape, or out of range, or if there are more branches
        than fit into memory.
    """
    grid = Grid(n=checked("n", n, FAMILY), **parameters)
    count = checked_number("points", points, POINTS)
    top = None
    if amplitude_max is not None:
        top = checked_number("amplitude_max", amplitude_max, POSITIVE)
    require_memory(count * grid.size, "points", "points or branches")
    return grid, top, count


def _branch_of(model: Model, n: int, amplitude_max: float | None, count: int) -> xr.Dataset:
    """The branch of a single ball up to some Λ, with this number of points.

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if it cannot be followed.
    """
    top = amplitude_max or default_top(model, n)
    if isinstance(model, RestitutionModel):
        return restitution_dataset(model, n, top, count)
    longest = max(LARGEST_STEP, _STRIDE * top)
    contact: Any = model
    row = SpringDamper([contact.frequency_ratio], contact.damping_ratio, contact.release)
    (found,) = follow_branches(row, [n], top, longest)
    if isinstance(found, NoOrbitError):
        raise found
    try:
        if isinstance(found, ContinuationError):
            raise found
        return branch_dataset(found, count)
    except ContinuationError as error:
        raise NoOrbitError(f"the branch of {n}-T orbits for {model.label}: {error}") from None
