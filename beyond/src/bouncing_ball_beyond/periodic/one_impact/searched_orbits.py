"""Orbits and bifurcations of models without a closed form, by a search.

A search starts from the orbit of the corrected restitution model whose signature is that of an
impact at the speed of the restitution model's orbit. Newton's method on the equations of the
model then finds the orbit, for many orbits at once. Bifurcations are solutions of these
equations together with a test function of stability. Where Newton's method fails, the branch is
followed instead, for one model at a time.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError
from bouncing_ball_beyond.inherited.numerics.corrector import checked, newton, tangent
from bouncing_ball_beyond.inherited.numerics.events import Event, SpecialPoint
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side, check_index
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.branches.following import branches_through_points
from bouncing_ball_beyond.periodic.one_impact import corrected_branch as line
from bouncing_ball_beyond.periodic.one_impact.orbits_of_model import OrbitsOfModel, in_order
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, LOWEST
from bouncing_ball_beyond.periodic.orbits.ends import ENDS, AtMargin, Window, ends_of_one_impact
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import solve_short
from bouncing_ball_beyond.periodic.orbits.special import bifurcations
from bouncing_ball_beyond.periodic.orbits.steps import EXTENDED, IN_ROUNDS, STEPS_OF_SEARCHES

# The largest number of Newton steps for the impact speed.
_ROUNDS = 6
# Rounds of Newton's method.
_TRIES = 5
# A branch is followed from Λ times this factor, for at most this many points.
_ABOVE = 1.3
_POINTS = 300
_FARTHER = 4.0
_HERE = "this amplitude"


def restitution_speed(
    n: ArrayLike, model: Model, last_step: float = 1e-3
) -> tuple[np.ndarray, Instant]:
    """v = 2πn/(1 + r(v)), the impact speed of the restitution model's n-T orbits, by Newton's
    method.

    Parameters
    ----------
    n : array_like of int
    model : Model
    last_step : float
        The method ends after a step below this part of the speed; the start of a search needs
        three digits.

    Returns
    -------
    speed : ndarray
        Has the broadcast shape of n and the model; its relative error is of the order of the square
        of the last step.
    instant : Instant
        The signature of the model's impact at the iterate of the speed before the last.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley
    >>> from bouncing_ball_beyond.models.contact_model import ContactModel
    >>> speed, _ = restitution_speed(1, ContactModel(HuntCrossley(1e3, 0.0)))
    >>> round(float(speed / np.pi), 12)
    1.0
    """
    period = 2 * np.pi * np.asarray(n, dtype=float)
    speed = period / 1.7 + np.zeros(model.shape)
    for _ in range(_ROUNDS):
        instant = model.signature(speed)
        slope = 1 + instant.restitution + instant.d_restitution * speed
        step = (period - (1 + instant.restitution) * speed) / slope
        speed = speed + step
        if not np.any(np.abs(step) > last_step * speed):
            break
    return speed, instant


class _Search(NamedTuple):
    """The orbits of a search along one axis: their models, n, and the signatures of the start.

    A single model serves all orbits. Points y are rows of an array, with arsinh Λ as their last
    entry.
    """

    model: Model
    n: np.ndarray
    instant: Instant

    @classmethod
    def of(
        cls, model: Model, n: ArrayLike, *more: ArrayLike
    ) -> tuple["_Search", list[np.ndarray], tuple[int, ...]]:
        """The search, the other arguments flattened like n, and the shape of the orbits."""
        check_index(n)
        instant = restitution_speed(n, model)[1]
        arrays = (n, *instant, *more, np.zeros(model.shape))
        columns = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in arrays))
        shape = columns[0].shape
        index, *rows = (x.reshape(-1) for x in columns[:-1])
        size = len(instant)
        search = cls(model.flat(shape), index.astype(int), Instant(*rows[:size]))
        return search, rows[size:], shape

    def guess(self, amplitude: np.ndarray, psi: np.ndarray) -> tuple[OrbitEquations, np.ndarray]:
        """The problem, and points y of the corrected model's orbits with instants at ψ."""
        t_c = self.instant.delay
        orbit = Orbit.of(
            self.model,
            self.n,
            amplitude,
            psi - t_c,
            self.instant.duration,
            t_c - self.n * np.pi,
        )
        return equations_of(orbit, LAMBDA)


def _solved(problem: OrbitEquations, guess: np.ndarray) -> np.ndarray:
    """Solutions at the Λ of each guess; NaN where Newton's method does not converge."""
    y = guess.copy()
    todo = np.flatnonzero(np.all(np.isfinite(guess), axis=-1))
    for _ in range(_TRIES):
        if not todo.size:
            break
        fixed, unknowns = problem.take(todo).fixed(y[todo])
        found = checked(solve_short(fixed.equations_at, unknowns, IN_ROUNDS), fixed.residual)
        y[todo, : fixed.size] = found.point
        todo = todo[~found.converged]
    y[todo] = np.nan
    return y


def _orbits(
    problem: OrbitEquations, y: np.ndarray, shape: tuple[int, ...]
) -> tuple[Orbit, np.ndarray]:
    """The orbits at a row of points, and the test function of their saddle-nodes, in the shape of
    the arguments; NaN where y is NaN.
    """
    known = np.flatnonzero(np.all(np.isfinite(y), axis=-1))
    columns = np.full((5, len(y)), np.nan)
    if known.size:
        fixed, unknowns = problem.take(known).fixed(y[known])
        found = orbit_of_point(fixed, unknowns)
        test = Bifurcation.SADDLE_NODE.test(*fixed.trace_and_determinant(unknowns))
        values = (found.amplitude, found.phase, found.contact_duration, found.impact_velocity)
        columns[:, known] = *values, test
    lam, phase, duration, velocity, test = columns.reshape(5, *shape)
    model = problem.balls.model
    n = np.broadcast_to(np.ravel(problem.periods), len(y)).reshape(shape)
    if model.shape:
        model = model[np.arange(len(y)).reshape(shape)]
    return Orbit.of(model, n, lam, phase, duration, velocity), test


def _on_branch(fold: Orbit, amplitude: float, side: Side) -> np.ndarray | float:
    """The first point at Λ on one side of the fold, or NaN.

    The branch is followed from the fold to both sides, each up to Λ, because one step across the
    fold may pass both orbits at Λ where they are close to each other.
    """
    if not amplitude >= fold.amplitude:
        return np.nan
    problem, start = equations_of(fold, LAMBDA)
    ahead = tangent(problem.jacobian(start), np.ones_like(start))
    ways = branches_through_points(
        problem,
        [start, start],
        ends_of_one_impact,
        Window(LOWEST, amplitude),
        towards=[ahead, -ahead],
        control=STEPS_OF_SEARCHES,
        most=_POINTS,
    )
    for way in ways:
        if isinstance(way, ContinuationError) or len(way) < 2:
            continue
        points = way.branch.points
        test = Bifurcation.SADDLE_NODE.test(*problem.trace_and_determinant(points[1]))
        here = abs(points[-1, -1] - np.arcsinh(amplitude)) <= EXTENDED.tolerance
        if here and (test > 0) == (side is Side.STABLE):
            return points[-1]
    return np.nan


def special_on_branch(
    model: Model, n: int, amplitude: float, farther: float = _FARTHER
) -> Sequence[SpecialPoint]:
    """Bifurcations and crossings of Λ along the branch of a single model.

    Parameters
    ----------
    model : Model
        A single model.
    n : int
    amplitude : float
        Λ; the points at which the branch crosses it have the name ``"this amplitude"``.
    farther : float
        The branch is followed at least up to this multiple of the larger of Λ and 1.

    Returns
    -------
    sequence of SpecialPoint
        In order from the stable side at large Λ down to the fold and beyond. Empty if no orbit
        is found to start from, or if the continuation fails before an end of the branch.
    """
    search, _, _ = _Search.of(model, [n])
    fold = float(np.nan_to_num(line.saddle_node(n, search.instant)[0]))
    above = np.array([max(amplitude, fold) * _ABOVE])
    problem, guess = search.guess(above, line.instant_phase(n, search.instant, above))
    y = _solved(problem, guess)[0]
    problem = problem.take(0)
    if np.any(np.isnan(y)):
        return ()
    most = max(farther * amplitude, farther, _ABOVE * float(above[0]))
    here = Event(_HERE, lambda y: y[..., -1] - np.arcsinh(amplitude))
    (found,) = branches_through_points(
        problem,
        [y],
        lambda one: [*bifurcations(one), *ends_of_one_impact(one), here],
        Window(LOWEST, most),
        towards=[-np.eye(y.size)[-1]],
        control=STEPS_OF_SEARCHES,
        most=_POINTS,
    )
    if isinstance(found, ContinuationError):
        return ()
    branch = found.branch
    # If the continuation failed, there may be further events beyond, and the list would be
    # incomplete.
    ends = branch.end.finished or branch.end.event in [*ENDS, *AtMargin]
    return branch.special if ends or len(branch.points) == _POINTS else ()


@dataclass(frozen=True)
class SearchedOrbits(OrbitsOfModel):
    """The n-T orbits of a model without a closed form, each from a search."""

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where no orbit is found.

        Parameters
        ----------
        n, amplitude : array_like
            Index of the family and Λ, which broadcast with the model.
        side : Side

        Returns
        -------
        Orbit
            Has the common shape. If Newton's method finds no orbit on this side, the branch of this
            model is searched, for one orbit at a time.

        Raises
        ------
        ModelError
            If n is not a positive integer, or the side is unknown.

        Examples
        --------
        The restitution model, whose orbits have a closed form:

        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> from bouncing_ball_beyond.periodic.one_impact import n_t
        >>> model = RestitutionModel(0.5)
        >>> found = SearchedOrbits(model).orbit([1, 2], 2.5, Side.STABLE)
        >>> bool(np.all(found.distance(n_t.orbit(model, [1, 2], 2.5)) < 1e-12))
        True
        """
        side = Side(side)
        search, (lam,), shape = _Search.of(self.model, n, amplitude)
        psi = line.instant_phase(search.n, search.instant, lam, side is Side.STABLE)
        # Next to the fold, the given Λ may lie below the fold of the corrected model.
        psi = np.where(np.isnan(psi), line.saddle_node_phase(search.instant), psi)
        problem, guess = search.guess(lam, psi)
        y = _solved(problem, guess)
        found, test = _orbits(problem, y, shape)
        on_side = test > 0 if side is Side.STABLE else test < 0
        if np.all(on_side):
            return found
        # The saddle-nodes of a single model, whose families have several Λ here.
        folds: dict[int, Orbit] = {}
        for k in np.flatnonzero(~np.broadcast_to(on_side, shape).reshape(-1) & np.isfinite(lam)):
            one = search.model.take(k)
            index = int(search.n[k])
            if self.model.shape or index not in folds:
                folds[index] = SearchedOrbits(one).saddle_node(index)
            y[k] = _on_branch(folds[index], float(lam[k]), side)
        return _orbits(problem, y, shape)[0]

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """The n-T orbits of a single model at one Λ, in order of contact duration, shape (count,).

        These are the orbits on the branch that comes from large Λ on its stable side. If this
        branch cannot be followed, they are the orbits on both sides of the fold.

        Raises
        ------
        ModelError
            If n is not a positive integer.
        """
        check_index(n)
        if amplitude >= self.saddle_node(n).amplitude:
            special = special_on_branch(self.model, int(n), float(amplitude))
            points = [each.point for each in special if each.name == _HERE]
            if points:
                search, _, _ = _Search.of(self.model, [n])
                problem, _ = search.guess(np.array([amplitude]), np.zeros(1))
                found = [orbit_of_point(problem.take(0), y) for y in points]
                return in_order(found, Orbit.of(self.model, n, amplitude, np.nan))
        return super().orbits(n, amplitude)

    def bifurcation(self, n: ArrayLike, kind: Bifurcation) -> Orbit:
        """The orbits at a bifurcation, with the broadcast shape of n and the model; NaN where none
        is found.

        Newton's method starts from the bifurcation of the corrected model. Where it fails, the
        branch is followed from large Λ, and the result is its first saddle-node or its last period
        doubling.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
        >>> found = SearchedOrbits(RestitutionModel(0.5)).saddle_node(1)
        >>> round(found.amplitude * 3 / np.pi, 10)
        1.0
        """
        search, _, shape = _Search.of(self.model, n)
        index = search.n
        if kind is Bifurcation.SADDLE_NODE:
            lam = line.saddle_node(index, search.instant)
            psi = line.saddle_node_phase(search.instant)
        else:
            lam, psi = line.period_doubling(index, search.instant)
        problem, guess = search.guess(lam, psi)
        found = newton(problem, guess, lambda y: problem.bifurcation(kind, y), EXTENDED)
        low = (lam < LOWEST) & (kind is Bifurcation.SADDLE_NODE)
        # Where Newton's method diverged Λ may overflow.
        with np.errstate(over="ignore"):
            reached = np.sinh(found.point[:, -1])
        # The phase is not defined at Λ = 0: rounding decides where near it the fold of an elastic
        # contact is found.
        good = found.converged & (reached > EXTENDED.tolerance) & (~low | (reached < 2 * lam))
        y = np.where(good[:, np.newaxis], found.point, np.nan)
        for k in np.flatnonzero(np.isnan(y[:, 0]) & ~low):
            near = float(np.nan_to_num(lam[k], nan=1.0))
            special = special_on_branch(search.model.take(k), int(index[k]), near)
            points = [each.point for each in special if each.name == kind]
            if points:
                y[k] = points[0 if kind is Bifurcation.SADDLE_NODE else -1]
        return _orbits(problem, y, shape)[0]

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """The orbits at the saddle-node."""
        return self.bifurcation(n, Bifurcation.SADDLE_NODE)

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """The orbits at the period doubling nearest to the saddle-node on the stable side."""
        return self.bifurcation(n, Bifurcation.PERIOD_DOUBLING)
