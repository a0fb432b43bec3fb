"""Orbits and bifurcations of any model, by continuation of its equations.

A search starts from the orbit of the corrected restitution model whose signature is that of an
impact at the speed of the restitution model's orbit. Newton's method on the equations of the
model then finds the orbit, for many orbits at once. Bifurcations are solutions of these
equations together with a test function of stability. Where Newton's method fails, the branch is
followed instead, for one model at a time.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.instant import Instant
from bouncing_ball.numerics.continuation import ContinuationError, StepControl, continue_branch
from bouncing_ball.numerics.corrector import NewtonSettings, newton, plane, tangent
from bouncing_ball.numerics.events import Event, SpecialPoint, parameter_bound, vanishing
from bouncing_ball.periodic import corrected_branch as corrected
from bouncing_ball.periodic.model import ImpactModel
from bouncing_ball.periodic.orbit import check_index
from bouncing_ball.periodic.stability import Bifurcation, Side

# The largest number of Newton steps for the impact speed. They end after a step below a
# thousandth of the speed: the remaining error is of the order of the square of this step, and
# the start of a search needs three digits.
_ROUNDS = 6
_ENOUGH = 1e-3
# Newton steps in each of several rounds; orbits that have converged are left out of the next
# round. The length of a step is limited because the first step may be long next to the fold.
_SETTINGS = NewtonSettings(max_iterations=5, longest=0.5)
_TRIES = 5
_EXTENDED = NewtonSettings(max_iterations=25)
# A branch is followed from Λ times this factor, with this step control, for at most this many
# points.
_ABOVE = 1.3
_STEPS = StepControl(initial=0.05, smallest=1e-3, largest=0.4, max_angle=0.25)
_POINTS = 300
_FARTHER = 4.0
# A fold below this Λ belongs to a nearly elastic contact; the steps along a branch are too long
# to resolve it.
_LOWEST = 1e-4
# The longest step as a fraction of Λ, where Λ is large.
_STRIDE = 0.05
# The parabola of a fold is measured at the first length along the branch. It is used up to the
# second number times the rise of Λ at that length.
_BESIDE = 1e-2
_PARABOLA = 4.0
_HERE = "this amplitude"


def restitution_speed(n: ArrayLike, model: Any) -> tuple[np.ndarray, Instant]:
    """v = 2πn/(1 + r(v)), the impact speed of the restitution model's n-T orbits, by Newton's
    method.

    Returns
    -------
    speed : ndarray
        Has the broadcast shape of n and the model; its relative error is of order 10⁻⁶.
    instant : Instant
        The signature of the model's impact at the iterate of the speed before the last.

    Examples
    --------
    >>> from bouncing_ball.models.laws.hertzian import HuntCrossley
    >>> from bouncing_ball.periodic.law_orbits import LawModel
    >>> speed, _ = restitution_speed(1, LawModel(HuntCrossley(1e3, 0.0)))
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
        if not np.any(np.abs(step) > _ENOUGH * speed):
            break
    return speed, instant


class _Search(NamedTuple):
    """The orbits of a search along one axis: their models, n, and the signatures of the start.

    A single model serves all orbits. Points y are rows of an array, with Λ as their last entry.
    """

    model: Any
    n: np.ndarray
    instant: Instant

    @classmethod
    def of(cls, model: Any, n: ArrayLike, *more: ArrayLike) -> tuple["_Search", Any, Any]:
        """The search, the other arguments flattened like n, and the shape of the orbits."""
        check_index(n)
        instant = restitution_speed(n, model)[1]
        arrays = (n, *instant, *more, np.zeros(model.shape))
        columns = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in arrays))
        shape = columns[0].shape
        index, *rows = (x.reshape(-1) for x in columns[:-1])
        size = len(instant)
        return cls(model.flat(shape), index, Instant(*rows[:size])), rows[size:], shape

    def start(self, amplitude: np.ndarray, psi: np.ndarray) -> np.ndarray:
        """Points y of the corrected model's orbits whose instants are at the phases ψ."""
        t_c = self.instant.delay
        orbit = self.model.orbit_of(
            self.n, amplitude, psi - t_c, self.instant.duration, t_c - self.n * np.pi
        )
        return self.model.system(self.n).point(orbit)

    def solved(self, guess: np.ndarray) -> np.ndarray:
        """Solutions at the Λ of each guess; NaN where Newton's method does not converge."""
        point = guess.copy()
        y = np.full_like(guess, np.nan)
        todo = np.flatnonzero(np.all(np.isfinite(guess), axis=-1))
        axis = np.eye(guess.shape[-1])[-1]
        for _ in range(_TRIES):
            if not todo.size:
                break
            system = self.model.take(todo).system(self.n[todo])
            at = plane(axis, point[todo])
            found = newton(system, point[todo], at, _SETTINGS)
            point[todo] = found.point
            y[todo[found.converged]] = found.point[found.converged]
            todo = todo[~found.converged & np.isfinite(found.step)]
        return y


def _shaped(model: Any, n: ArrayLike, y: np.ndarray, shape: tuple[int, ...]) -> Any:
    return model.system(n).orbit(y.reshape(*shape, y.shape[-1]))


def orbit_at(model: Any, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Any:
    """The n-T orbits at Λ on one side of the saddle-node; NaN where no orbit is found.

    Parameters
    ----------
    model : ImpactModel
    n, amplitude : array_like
        Index of the family and Λ, which broadcast with the model.
    side : Side
        Or its name, such as ``"stable"``.

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

    >>> from bouncing_ball.periodic.restitution_model import RestitutionModel
    >>> model = RestitutionModel(0.5)
    >>> found = orbit_at(model, [1, 2], 2.5, Side.STABLE)
    >>> bool(np.all(found.distance(model.orbit([1, 2], 2.5)) < 1e-12))
    True
    """
    side = Side(side)
    search, (lam,), shape = _Search.of(model, n, amplitude)
    psi = corrected.instant_phase(search.n, search.instant, lam, side is Side.STABLE)
    # Next to the fold, the given Λ may lie below the fold of the corrected model.
    psi = np.where(np.isnan(psi), corrected.saddle_node_phase(search.instant), psi)
    y = search.solved(search.start(lam, psi))
    found = _shaped(model, n, y, shape)
    test = Bifurcation.SADDLE_NODE.test(*found.trace_and_determinant())
    on_side = test > 0 if side is Side.STABLE else test < 0
    if np.all(on_side):
        return found
    # The saddle-nodes of a single model, whose families have several Λ here.
    folds: dict[int, Any] = {}
    for k in np.flatnonzero(~np.broadcast_to(on_side, shape).reshape(-1) & np.isfinite(lam)):
        one = search.model.take(k)
        index = int(search.n[k])
        if model.shape or index not in folds:
            folds[index] = one.saddle_node(index)
        y[k] = _on_branch(one, folds[index], float(lam[k]), side)
    return _shaped(model, n, y, shape)


def _on_branch(model: Any, fold: Any, amplitude: float, side: Side) -> np.ndarray | float:
    """The point at Λ on one side of the fold, on the part of the branch next to it, or NaN."""
    n = int(fold.n)
    if not amplitude >= float(fold.amplitude):
        return np.nan
    y = _beside_fold(model.system(n), model.system(n).point(fold), amplitude, side)
    if np.all(np.isfinite(y)):
        return y
    found = continued(model, n, amplitude, farther=_ABOVE)
    names = [special.name for special in found]
    if Bifurcation.SADDLE_NODE not in names:
        return np.nan
    # The branch runs from the stable side, on which it crosses Λ once, across the fold.
    at = names.index(Bifurcation.SADDLE_NODE)
    beside = found[:at] if side is Side.STABLE else found[at:]
    return next((special.point for special in beside if special.name == _HERE), np.nan)


def _beside_fold(system: Any, fold: np.ndarray, amplitude: float, side: Side) -> np.ndarray:
    """The point at Λ on one side of a fold, by the parabola Λ - Λ_SN ~ s²; NaN far from the fold.

    The parabola is needed because one step of the continuation may pass both orbits at Λ where
    they are close to each other.
    """
    along = tangent(system.jacobian(fold), np.ones_like(fold))
    beside = fold + _BESIDE * along
    step = newton(system, beside, plane(along, beside), _SETTINGS).point - fold
    y = np.full_like(fold, np.nan)
    if not (step[-1] > 0 and amplitude - fold[-1] < _PARABOLA * step[-1]):
        return y
    share = np.sqrt((amplitude - fold[-1]) / step[-1])
    guesses = fold + share * np.outer([1, -1], step)
    guesses[:, -1] = amplitude
    for guess in guesses:
        found = newton(system, guess, plane(np.eye(fold.size)[-1], guess), _EXTENDED)
        test = Bifurcation.SADDLE_NODE.test(*system.orbit(found.point).trace_and_determinant())
        if found.converged and (test > 0) == (side is Side.STABLE):
            y = found.point
    return y


def continued(
    model: Any, n: int, amplitude: float, farther: float = _FARTHER
) -> Sequence[SpecialPoint]:
    """Bifurcations and crossings of Λ along the branch of a single model.

    Parameters
    ----------
    model : ImpactModel
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
    system = model.system(n)
    search, _, _ = _Search.of(model, [n])
    fold = float(np.nan_to_num(corrected.saddle_node(n, search.instant)[0]))
    start = np.array([max(amplitude, fold) * _ABOVE])
    y = search.solved(search.start(start, corrected.instant_phase(n, search.instant, start)))[0]
    most = max(farther * amplitude, farther, _ABOVE * float(start[0]))
    events = (
        *system.events(),
        Event(_HERE, lambda y: y[..., -1] - amplitude),
        parameter_bound(most, upper=True, reason=f"Λ = {most:g}"),
        parameter_bound(_LOWEST, upper=False, reason=f"Λ = {_LOWEST:g}"),
    )
    if np.any(np.isnan(y)):
        return ()
    # Far above the fold, Λ makes up most of the arclength.
    control = replace(_STEPS, largest=max(_STEPS.largest, _STRIDE * amplitude))
    try:
        branch = continue_branch(
            system, y, increasing=False, events=events, control=control, max_points=_POINTS
        )
    except ContinuationError:
        return ()
    # If the continuation failed, there may be further events beyond, and the list would be
    # incomplete.
    return branch.special if branch.end.finished or len(branch.points) == _POINTS else ()


def orbits_at(model: Any, n: int, amplitude: float) -> Any:
    """The n-T orbits of a single model at one Λ, in order of contact duration, shape (count,).

    These are the orbits on the branch that comes from large Λ on its stable side. If this branch
    cannot be followed, they are the orbits on both sides of the fold.

    Raises
    ------
    ModelError
        If n is not a positive integer.
    """
    check_index(n)
    if amplitude >= float(model.saddle_node(n).amplitude):
        special = continued(model, int(n), float(amplitude))
        points = [each.point for each in special if each.name == _HERE]
        if points:
            found = model.system(n).orbit(np.array(points))
            return found[np.argsort(found.contact_duration)]
    return ImpactModel.orbits(model, n, amplitude)


def bifurcation(model: Any, n: ArrayLike, kind: Bifurcation) -> Any:
    """The orbits at a bifurcation, with the broadcast shape of n and the model; NaN where none is
    found.

    Newton's method starts from the bifurcation of the corrected model. Where it fails, the branch
    is followed from large Λ, and the result is its first saddle-node or its last period doubling.

    Examples
    --------
    >>> from bouncing_ball.periodic.restitution_model import RestitutionModel
    >>> found = bifurcation(RestitutionModel(0.5), 1, Bifurcation.SADDLE_NODE)
    >>> round(float(found.amplitude * 3 / np.pi), 10)
    1.0
    """
    search, _, shape = _Search.of(model, n)
    index = search.n
    if kind is Bifurcation.SADDLE_NODE:
        lam = corrected.saddle_node(index, search.instant)
        psi = corrected.saddle_node_phase(search.instant)
    else:
        lam, psi = corrected.period_doubling(index, search.instant)
    system = search.model.system(index)
    test = vanishing(lambda y: kind.test(*system.orbit(y).trace_and_determinant()))
    found = newton(system, search.start(lam, psi), test, _EXTENDED)
    low = (lam < _LOWEST) & (kind is Bifurcation.SADDLE_NODE)
    # The phase is not defined at Λ = 0: rounding decides where near it the fold of an elastic
    # contact is found.
    reached = found.point[:, -1]
    good = found.converged & (reached > _EXTENDED.tolerance) & (~low | (reached < 2 * lam))
    y = np.where(good[:, np.newaxis], found.point, np.nan)
    for k in np.flatnonzero(np.isnan(y[:, 0]) & ~low):
        near = float(np.nan_to_num(lam[k], nan=1.0))
        special = continued(search.model.take(k), int(index[k]), near)
        points = [each.point for each in special if each.name == kind]
        if points:
            y[k] = points[0 if kind is Bifurcation.SADDLE_NODE else -1]
    return _shaped(model, n, y, shape)


class ContinuedModel(ImpactModel):
    """A model whose orbits at Λ and bifurcations are found by continuation from its signature."""

    has_closed_form: ClassVar[bool] = False

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> Any:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where no orbit is found.

        Arguments, shape and errors are those of :meth:`.ImpactModel.orbit`.
        """
        return orbit_at(self, n, amplitude, side)

    def saddle_node(self, n: ArrayLike) -> Any:
        """The orbits at the saddle-node; NaN where none is found.

        Arguments, shape and errors are those of :meth:`.ImpactModel.saddle_node`.
        """
        return bifurcation(self, n, Bifurcation.SADDLE_NODE)

    def period_doubling(self, n: ArrayLike) -> Any:
        """The orbits at the period doubling nearest to the saddle-node; NaN where none is found.

        Arguments, shape and errors are those of :meth:`.ImpactModel.period_doubling`.
        """
        return bifurcation(self, n, Bifurcation.PERIOD_DOUBLING)
