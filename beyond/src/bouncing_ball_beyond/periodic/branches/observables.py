"""Quantities of orbits, and of branches with their special orbits and ends, as datasets have them.

The variables of a branch are the observables along it, over the dimension ``point``, and the place
of each special orbit, over ``special``: its bifurcations, and the grazing orbits, at which the
orbits become inadmissible.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball_beyond.inherited.datasets.variables import Variable
from bouncing_ball_beyond.inherited.periodic import branches
from bouncing_ball_beyond.inherited.periodic.branches import OBSERVED
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.branches.following import Followed, places, unrolled
from bouncing_ball_beyond.periodic.orbits import stability
from bouncing_ball_beyond.periodic.orbits.balls import FREQUENCY, LAMBDA
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, certain_digits, largest_defect
from bouncing_ball_beyond.periodic.orbits.saved import columns_of
from bouncing_ball_beyond.periodic.orbits.special import Special

VARIABLES = {
    FREQUENCY: Variable("frequency of the table over √(g/a) at a fixed stroke a"),
    "special_point": Variable("number of the last point of the branch before the special orbit"),
    "digits_left": Variable(
        "certain decimal digits of the states, see Orbit.digits_left", budget=math.inf
    ),
}
OF_BRANCHES = branches.VARIABLES | VARIABLES
"""The variables of branches: those of the inherited library, and these."""


def columns(orbit: Orbit, *names: str) -> dict[str, np.ndarray]:
    """The named quantities of orbits, with the stability and the admissibility of the orbits.

    Every array has the shape of the orbits.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> found = columns(Orbit.of(RestitutionModel(1.0), 1, 0.5, np.pi / 2), "phase")
    >>> found
    {'phase': 1.5707963267948966, 'stable': False, 'admissible': True}
    """
    judged = {"stable": orbit.is_stable(), "admissible": orbit.is_admissible()}
    return {name: getattr(orbit, name) for name in names} | judged


def branch_variables(found: Followed) -> dict[str, Any]:
    """The orbits along a branch or a curve, its special orbits, and the reasons for its two ends,
    as the variables and the coordinates of a dataset.

    Over ``point``, they have each parameter that varies, ``stable``, ``admissible``, ``residual``
    and ``digits_left``, and over (point, impact) the observables of the orbits, with phases that
    pass ±π continuously. The multipliers are over (point, multiplier), ``special_…`` over
    ``special``, of which phases and durations are over (special, impact) too, and ``end_reason``
    over ``end``. ``special_point`` is the number of the last point before a special orbit. The
    variables of :mod:`~bouncing_ball_beyond.periodic.orbits.saved` are among them, so that the
    orbits come back.
    """
    special = _special_places(found)
    points = found.points_with_special
    varied = found.problem.equations.values(found.problem.inner(points))
    ends = [str(found.branch.start), str(found.branch.end)]
    orbits = found.with_special
    ahead = unrolled(found.problem, points, orbits)
    return _in_columns(orbits, ahead, _judged(found), varied, special, ends)


class _Judged(NamedTuple):
    """Multipliers, stability, the largest defect and the certain digits of orbits in a row."""

    multipliers: np.ndarray
    stable: np.ndarray
    defect: np.ndarray
    digits_left: np.ndarray


def _judged(found: Followed) -> _Judged:
    """The judgement of the orbits along a branch, and of its special orbits after them, by the
    equations of the branch.
    """
    equations = found.problem.equations
    y = found.problem.inner(found.points_with_special)
    # The values of the parameters are known along a branch, so that they count as given.
    given = slice(equations.size)
    residual, matrix = equations.equations_at(y)
    floquet = equations.trace_and_determinant(y)
    return _Judged(
        multipliers=stability.multipliers(*floquet),
        stable=stability.is_stable(*floquet),
        defect=largest_defect(residual),
        digits_left=certain_digits(y[..., given], residual, matrix[..., given]),
    )


class _Special(NamedTuple):
    """The kinds of the special points of a branch, and what :func:`.places` says of them."""

    kinds: list[str]
    before: np.ndarray
    arclength: np.ndarray


def _special_places(found: Followed) -> _Special:
    special = found.special_points
    return _Special(
        [str(each.name) for each in special],
        *places([each.point for each in special], found.branch.points),
    )


def _in_columns(
    orbits: Orbit,
    ahead: Orbit,
    judged: _Judged,
    varied: dict[str, np.ndarray],
    special: _Special,
    ends: list[str],
) -> dict[str, Any]:
    """The variables of :func:`branch_variables`, from the orbits along a branch with its special
    orbits after them, with phases in [-π, π] and, ``ahead``, with phases that pass ±π, and the
    values of the parameters that vary.
    """
    count = orbits.size - len(special.kinds)
    data: dict[str, Any] = {}
    for name, values in varied.items():
        data[name] = "point", values[:count]
        data[f"special_{name}"] = "special", values[count:]
    observed = {
        name: np.reshape(getattr(ahead, name), (ahead.size, ahead.impacts)) for name in OBSERVED
    }
    data |= {name: (("point", "impact"), values[:count]) for name, values in observed.items()}
    for name in ("phase", "contact_duration"):
        data[f"special_{name}"] = ("special", "impact"), observed[name][count:]
    data["stable"] = "point", judged.stable[:count]
    data["admissible"] = "point", ahead.is_admissible()[:count]
    data["residual"] = "point", judged.defect[:count]
    data["digits_left"] = "point", judged.digits_left[:count]
    floquet = judged.multipliers[:count]
    data["multiplier_real"] = ("point", "multiplier"), floquet.real
    data["multiplier_imag"] = ("point", "multiplier"), floquet.imag
    kinds = np.array(special.kinds, dtype=str)
    data["special_kind"] = "special", kinds
    # Where a release is lost, which is a double zero, rounding decides which release is found.
    lost = kinds == Special.RELEASE_LOST
    data["special_residual"] = "special", np.where(lost, np.nan, judged.defect[count:])
    data["end_reason"] = "end", ends
    # Numbers, so that branches with different numbers of special points are aligned.
    data["special"] = "special", np.arange(len(kinds))
    data["end"] = "end", ["start", "end"]
    data["special_arclength"] = "special", special.arclength
    data["special_point"] = "special", special.before
    along = columns_of(orbits[:count], "point")
    there = columns_of(orbits[count:], "special", "special_")
    # No special orbit has parameters of its own if there is none.
    over_points = (name for name, (dims, _) in along.items() if dims == ("point",))
    none = {f"special_{name}": ("special", np.empty(0)) for name in over_points}
    # The observables come first, and their phases pass ±π.
    return data | ({} if len(kinds) else none) | there | along | data


def n_t_columns(found: Followed) -> xr.Dataset:
    """:func:`branch_variables` of orbits with one impact, from the unstable to the stable side,
    without an axis of the impacts.
    """
    return _of_one_impact(branch_variables(found))


def _of_one_impact(columns: dict[str, Any]) -> xr.Dataset:
    one = xr.Dataset(columns).isel(impact=0, drop=True)
    kinds = one.special_kind.astype(object)
    return one.assign(special_kind=kinds).assign_coords(end=["unstable side", "stable side"])


def no_branch(count: int, error: Exception) -> xr.Dataset:
    """A dataset like that of :func:`n_t_columns`, of NaN, with the error as its end reasons."""
    none = Orbit.of(RestitutionModel(1.0), 1, np.full(count, np.nan), np.nan)
    judged = _Judged(none.multipliers(), none.is_stable(), none.defect(), none.digits_left())
    nowhere = _Special([], np.empty(0, int), np.empty(0))
    ends = [str(error)] * 2
    return _of_one_impact(_in_columns(none, none, judged, {LAMBDA: none.amplitude}, nowhere, ends))
