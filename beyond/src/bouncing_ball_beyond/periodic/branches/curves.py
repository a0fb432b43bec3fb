r"""Curves of special orbits in two parameters.

A saddle-node, a period doubling or a grazing orbit is a solution of the equations of the orbit and
of one more equation, g = 0. With two parameters the solutions are a curve, which is followed in
the same way as a branch. The end of sticking alone has no such g. Its curve is followed from point
to point, by :mod:`~bouncing_ball_beyond.periodic.branches.sticking_curve`. On the other curves
these points are named:

* a cusp, where two saddle-nodes meet: the curve turns back in the plane of the parameters;
* a generalized period doubling, where the coefficient of the normal form vanishes: the doublings on
  one side of it are supercritical and those on the other side subcritical, and a curve of
  saddle-nodes of the doubled orbits ends there;
* the resonances 1:1 and 1:2, where both multipliers are 1 on a curve of saddle-nodes, or -1 on one
  of period doublings. The product of the multipliers is below 1 for every contact that dissipates,
  so that a curve meets a resonance only where the dissipation ends, for example at r = 1.

A fold-flip, with the multipliers 1 and -1, does not occur: the determinant of the return map would
be -1, and it is a product of positive contractions.

At a cusp the tangent of the curve lies in the direction u of the null vector of the orbit's
equations alone. The cusp is therefore a zero of the derivative of g in the direction u.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError
from bouncing_ball_beyond.inherited.numerics.branch import Branch, ContinuationError, End, EndKind
from bouncing_ball_beyond.inherited.numerics.corrector import Condition, null_vector
from bouncing_ball_beyond.inherited.numerics.events import Event, SpecialPoint, vanishing
from bouncing_ball_beyond.inherited.numerics.pseudo_arclength import continue_all_both_ways
from bouncing_ball_beyond.inherited.numerics.steps import StepControl, WithEvents
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.periodic.branches.following import (
    Followed,
)
from bouncing_ball_beyond.periodic.branches.grazing import lowest_touch
from bouncing_ball_beyond.periodic.branches.sticking_curve import sticking_curve
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, LOWEST, Path
from bouncing_ball_beyond.periodic.orbits.ends import (
    CLOSE,
    Window,
    accumulation,
    events_along,
    explained,
    impact_lost,
    limits_of,
    places_in_words,
    release_lost,
)
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.normal_form import coefficient
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import solution_near
from bouncing_ball_beyond.periodic.orbits.special import Degenerate, Special, passed_by
from bouncing_ball_beyond.periodic.orbits.steps import BY_DIFFERENCES, PATIENT, STEPS_OF_CURVES

# A point on a resonance has multipliers that differ from it by less than this. Next to a double
# multiplier the multipliers differ by the square root of rounding.
_RESONANT = 1e-6
# A start that is farther from the corrected special orbit is none of its kind. Special orbits are
# located to 1e-12, and those before a singular end of a branch to about 1e-5.
_ANOTHER = 1e-3
# The coefficient of doublings is computed at every so many points of a curve: it takes about as
# long as a point, and changes slowly.
_STRIDE = 4
_INFLECTION = "where the flight touches the table, its minimum merges with a maximum"


def condition_of(equations: OrbitEquations, kind: Special) -> Condition:
    """g and its gradient for a kind of special orbit.

    Raises
    ------
    ParameterError
        If there is no curve of such orbits.
    """
    events = {each.name: each for each in passed_by(equations)}
    if kind not in events:
        raise ParameterError(f"{{}} is not one of {', '.join(events)}", repr(str(kind)))
    event = events[kind]
    return event.condition or vanishing(event.function)


@dataclass(frozen=True)
class CurveProblem:
    """Special orbits in two parameters as a
    :class:`~bouncing_ball_beyond.inherited.numerics.corrector.Problem`.

    ``equations`` has two parameters that vary, and ``condition`` is g with its gradient.
    """

    equations: OrbitEquations
    condition: Condition

    def residual(self, y: np.ndarray) -> np.ndarray:
        """The equations of the orbit and g, shape (..., N + 1)."""
        value, _ = self.condition(y)
        return np.concatenate([self.equations.residual(y), value[..., np.newaxis]], axis=-1)

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Its Jacobian, shape (..., N + 1, N + 2)."""
        _, gradient = self.condition(y)
        matrix = self.equations.jacobian(y)
        return np.concatenate([matrix, gradient[..., np.newaxis, :]], axis=-2)


def curve_through(
    start: Orbit,
    kind: Special,
    along: str | Path,
    across: str | Path,
    *,
    along_window: Window | None = None,
    across_window: Window | None = None,
    control: StepControl = STEPS_OF_CURVES,
    most: int = 1000,
) -> Followed:
    """The curve of special orbits through one of them, in both directions.

    Parameters
    ----------
    start : Orbit
        A special orbit of the kind, for example one of :attr:`.Followed.special`.
    kind : Special
    along, across : str or Path
        The two parameters, of which one may be a path.
    along_window, across_window : Window, optional
        The ranges of the two parameters outside which the curve is not followed.
    control : StepControl
    most : int
        Number of points in each direction after which the curve is left unfinished.

    Raises
    ------
    NoOrbitError
        If there is no such orbit near the start.
    ParameterError
        If the balls have no such parameter, or no curve is defined for the kind.
    """
    equations, guess = equations_of(start, along, across)
    given = zip(equations.along, (along_window, across_window), strict=True)
    windows = _ranges(equations, dict(given))
    if kind is Special.STICKING:
        first, second = windows.values()
        return Followed(equations, sticking_curve(equations, guess, (first, second), most))
    problem = CurveProblem(equations, condition_of(equations, kind))
    limits = limits_of(equations, *windows.values())
    first = _special_at(problem, guess)
    if np.linalg.norm(first - guess) > _ANOTHER:
        places = orbit_of_point(equations, first).parameters.items()
        where = ", ".join(f"{name} = {x:.10g}" for name, x in places)
        raise NoOrbitError(f"the start is no {kind}; Newton's method leads to another at {where}")
    with np.errstate(all="ignore"):
        ends = [impact_lost(equations), release_lost(equations), *limits]
        tested = WithEvents(problem, ends)
        (branch,) = continue_all_both_ways(lambda _: tested, [first], control, most)
        if isinstance(branch, ContinuationError):
            raise NoOrbitError(str(branch))
        special = [
            *_cusps(problem, branch, kind),
            *_resonances(problem, branch, kind),
            *_generalized(problem, branch, kind),
        ]
        named = replace(
            branch,
            special=tuple(special),
            start=_explained_end(problem, branch.start, branch.points, kind, windows),
            end=_explained_end(problem, branch.end, branch.points[::-1], kind, windows),
        )
    return Followed(equations, named)


def _explained_end(
    problem: CurveProblem, end: End, points: np.ndarray, kind: Special, ranges: dict[str, Window]
) -> End:
    """An end of a curve in words, with what is there if its steps became too short."""
    if not end.stuck:
        return end
    equations = problem.equations
    if kind is Special.GRAZING_FLIGHT and lowest_touch(equations, points[0]).acceleration < CLOSE:
        return End(f"{_INFLECTION}, at about {places_in_words(equations, points[0])}")
    tests = [each for each in events_along(equations) if each.name != kind]
    # The tangents of a curve also turn where the differences of its condition fail, which is no
    # corner of the map.
    stuck = end._replace(kind=EndKind.SHORTEST_STEP)
    found = explained(equations, stuck, points, tests, limits_of(equations, *ranges.values()))
    if found.stuck:
        found = accumulation(equations, found, points, ranges, STEPS_OF_CURVES.creep)
    if found.stuck:
        where = places_in_words(equations, points[0])
        return End(
            f"the curve could not be continued beyond {where}: no step was short enough", False
        )
    return found


def _special_at(problem: CurveProblem, y: np.ndarray) -> np.ndarray:
    """The special orbit with the second parameter of y."""
    with np.errstate(all="ignore"):
        point, why = solution_near(problem, y, PATIENT)
    if why:
        raise NoOrbitError(f"no special orbit was found near the start of the curve: {why}")
    return point


def _ranges(equations: OrbitEquations, windows: dict[str, Window | None]) -> dict[str, Window]:
    """The ranges of both parameters, inside their windows if there are any."""
    found = {}
    for name, window in windows.items():
        low, high = equations.balls.bounds(name)
        if name == LAMBDA:
            low = LOWEST
        if window is not None:
            low = max(low, window.low)
            high = min(high, window.high)
        found[name] = Window(low, high)
    return found


def _null_vector(equations: OrbitEquations, y: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """u with a zero for each parameter, oriented along a reference, shape (..., N + 2)."""
    matrix = equations.jacobian(y)[..., : equations.size]
    vector = null_vector(matrix)
    vector = vector * np.where(vector @ reference < 0, -1.0, 1.0)[..., np.newaxis]
    none = np.zeros((*y.shape[:-1], 2))
    return np.concatenate([vector, none], axis=-1)


def _cusps(problem: CurveProblem, branch: Branch, kind: Special) -> list[SpecialPoint]:
    """The cusps, which lie where the direction in the plane of the parameters is reversed."""
    if kind is not Special.SADDLE_NODE:
        return []
    equations = problem.equations
    direction = branch.tangents[:, -2:]
    turned = np.flatnonzero(np.sum(direction[1:] * direction[:-1], axis=-1) < 0)
    found = []
    for k in turned:
        left = branch.points[k]
        right = branch.points[k + 1]
        reference = _null_vector(equations, left, branch.tangents[k, : equations.size])
        test = _quadratic(problem, reference[: equations.size])
        cusp = Event(Degenerate.CUSP, test).locate(problem, left, right, BY_DIFFERENCES)
        if cusp is not None:
            found.append(cusp)
    return found


def _quadratic(problem: CurveProblem, reference: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """The derivative of g in the direction u, a function of y."""

    def test(y: np.ndarray) -> np.ndarray:
        _, gradient = problem.condition(y)
        return np.sum(gradient * _null_vector(problem.equations, y, reference), axis=-1)

    return test


def _resonances(problem: CurveProblem, branch: Branch, kind: Special) -> list[SpecialPoint]:
    """The resonances at the ends of the curve and between its points, where det M passes 1."""
    names = {
        Special.SADDLE_NODE: Degenerate.ONE_TO_ONE,
        Special.PERIOD_DOUBLING: Degenerate.ONE_TO_TWO,
    }
    if kind not in names:
        return []
    name = names[kind]

    def excess(y: np.ndarray) -> np.ndarray:
        return problem.equations.trace_and_determinant(y)[1] - 1

    values = excess(branch.points)
    if np.all(np.abs(values) < _RESONANT):
        # Without dissipation every point has two equal multipliers, and none is special.
        return []
    found = [
        SpecialPoint(name, branch.points[end]) for end in (0, -1) if abs(values[end]) < _RESONANT
    ]
    inner = np.flatnonzero((values[1:] > _RESONANT) != (values[:-1] > _RESONANT))
    for k in inner:
        place = Event(name, excess).locate(problem, branch.points[k], branch.points[k + 1])
        if place is not None:
            found.append(place)
    return found


def _generalized(problem: CurveProblem, branch: Branch, kind: Special) -> list[SpecialPoint]:
    """The places between points of the curve where the coefficient of the doublings vanishes."""
    if kind is not Special.PERIOD_DOUBLING:
        return []

    def cubic(y: np.ndarray) -> np.ndarray:
        rows = y.reshape(-1, y.shape[-1])
        return np.reshape([_cubic(problem.equations, row) for row in rows], y.shape[:-1])

    event = Event(Degenerate.GENERALIZED, cubic)
    found = []
    for start, stop in _sign_changes(cubic, branch.points):
        between = branch.points[start : stop + 1]
        # Newton's method from the ends of several steps may leave them, and the ranges.
        for k, _ in _sign_changes(cubic, between, stride=1):
            place = event.locate(problem, between[k], between[k + 1], BY_DIFFERENCES)
            if place is not None:
                found.append(place)
    return found


def _sign_changes(
    function: Callable[[np.ndarray], np.ndarray], points: np.ndarray, stride: int = _STRIDE
) -> list[tuple[int, int]]:
    """The numbers of neighbours among every so many points between which a function changes its
    sign; where it is not defined it changes none.
    """
    last = len(points) - 1
    tested = np.unique([*range(0, last, stride), last])
    values = function(points[tested])
    changed = np.flatnonzero(values[1:] * values[:-1] < 0)
    return [(int(tested[k]), int(tested[k + 1])) for k in changed]


def _cubic(equations: OrbitEquations, y: np.ndarray) -> float:
    """The coefficient of a period doubling; NaN outside the ranges of the parameters, where
    Newton's method may try points, and at a 1:2 resonance, which has another normal form.
    """
    dynamics, _ = equations.dynamics(y)
    if dynamics is None or _is_resonant(equations, y):
        return np.nan
    return coefficient(equations, y, Bifurcation.PERIOD_DOUBLING)[0]


def _is_resonant(equations: OrbitEquations, y: np.ndarray) -> np.ndarray:
    """Whether det M is 1, so that both multipliers of a saddle-node or of a doubling are equal."""
    return np.abs(equations.trace_and_determinant(y)[1] - 1) < _RESONANT
