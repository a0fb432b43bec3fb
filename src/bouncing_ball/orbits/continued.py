"""Orbits and bifurcations of any model, by continuation of its equations.

A search starts from the orbit of the corrected restitution model with the signature of the
impact at the speed of the restitution model's orbit, and is closed by Newton's method on the
model's own equations, for many orbits at once. Bifurcations are solutions of these
equations extended by the stability's test function. What is not found so is looked for along
the branch of each single model.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.signature import Instant
from bouncing_ball.continuation.branch import ContinuationError, continue_branch
from bouncing_ball.continuation.corrector import NewtonSettings, newton, plane
from bouncing_ball.continuation.events import Event, SpecialPoint, parameter_bound, vanishing
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.orbits import corrected_branch as corrected
from bouncing_ball.orbits.orbit import check_index
from bouncing_ball.orbits.stability import Bifurcation, Side

# Newton steps for the speed of the orbit, and the last one: what is left is its square, and a
# start needs three digits.
_ROUNDS, _ENOUGH = 6, 1e-3
# Newton steps, in so many rounds; those that are done leave after each. A first step may be
# long next to the fold.
_SETTINGS = NewtonSettings(max_iterations=5, longest=0.5)
_TRIES = 5
_EXTENDED = NewtonSettings(max_iterations=25)
# A branch, for all orbits at one Λ: from so far above it, in not too many steps.
_ABOVE = 1.3
_STEPS = StepControl(initial=0.05, smallest=1e-3, largest=0.4, max_angle=0.25)
_POINTS = 300
_FARTHER = 4.0
# A fold so low is one of nearly elastic contacts: no step of a branch resolves it.
_LOWEST = 1e-4
# Longest step, in parts of a large Λ.
_STRIDE = 0.05
_HERE = "this amplitude"


def restitution_speed(n: ArrayLike, model: Any) -> tuple[np.ndarray, Instant]:
    """v = 2πn/(1 + r(v)), the impact speed of the restitution model's n-T orbits, and
    the signature of the model's impact next to it.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> from bouncing_ball.orbits.law_model import LawModel
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
    """Orbits that are looked for, in a row: the models, n and the signatures to start from.

    A single model is that of all; points y are rows too, with Λ as their last entry.
    """

    model: Any
    n: np.ndarray
    instant: Instant

    @classmethod
    def of(cls, model: Any, n: ArrayLike, *more: ArrayLike) -> tuple["_Search", Any, Any]:
        """The search, everything else in a row as well, and the shape of the orbits."""
        check_index(n)
        instant = restitution_speed(n, model)[1]
        arrays = (n, *instant, *more, np.zeros(model.shape))
        columns = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in arrays))
        shape = columns[0].shape
        index, *rows = (x.reshape(-1) for x in columns[:-1])
        size = len(instant)
        return cls(model.flat(shape), index, Instant(*rows[:size])), rows[size:], shape

    def start(self, amplitude: np.ndarray, psi: np.ndarray) -> np.ndarray:
        """Points of the corrected model's orbits with instants at the phases ψ."""
        t_c = self.instant.delay
        orbit = self.model.orbit_of(
            self.n, amplitude, psi - t_c, self.instant.duration, t_c - self.n * np.pi
        )
        return self.model.system(self.n).point(orbit)

    def solved(self, guess: np.ndarray) -> np.ndarray:
        """Solutions at the guesses' own Λ; NaN where none was found."""
        point, y = guess.copy(), np.full_like(guess, np.nan)
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
    """The n-T orbits at Λ on a side of the saddle-node; NaN where none is found."""
    search, (lam,), shape = _Search.of(model, n, amplitude)
    psi = corrected.instant_phase(search.n, search.instant, lam, side is Side.STABLE)
    # Next to the fold the start may lie below it.
    psi = np.where(np.isnan(psi), corrected.saddle_node_phase(search.instant), psi)
    y = search.solved(search.start(lam, psi))
    found = _shaped(model, n, y, shape)
    test = Bifurcation.SADDLE_NODE.test(*found.trace_and_determinant())
    on_side = test > 0 if side is Side.STABLE else test < 0
    if np.all(on_side):
        return found
    for k in np.flatnonzero(~np.broadcast_to(on_side, shape)):
        y[k] = _on_branch(search.model.take(k), int(search.n[k]), float(lam[k]), side)
    return _shaped(model, n, y, shape)


def _on_branch(model: Any, n: int, amplitude: float, side: Side) -> np.ndarray | float:
    """The point at Λ on a side of the fold that is next to it along the branch, or NaN."""
    if not amplitude >= float(model.saddle_node(n).amplitude):
        return np.nan
    found = continued(model, n, amplitude, farther=_ABOVE)
    names = [special.name for special in found]
    if Bifurcation.SADDLE_NODE not in names:
        return np.nan
    # The branch runs from the stable side over the fold.
    fold = names.index(Bifurcation.SADDLE_NODE)
    beside = found[:fold][::-1] if side is Side.STABLE else found[fold:]
    return next((special.point for special in beside if special.name == _HERE), np.nan)


def continued(
    model: Any, n: int, amplitude: float, farther: float = _FARTHER
) -> Sequence[SpecialPoint]:
    """Bifurcations, and what is at Λ, on the branch of a single model.

    In the order from its stable side down to the fold and on; none where it cannot be started
    or followed.
    """
    system, (search, _, _) = model.system(n), _Search.of(model, [n])
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
    # Far above the fold Λ is most of the arclength.
    control = replace(_STEPS, largest=max(_STEPS.largest, _STRIDE * amplitude))
    try:
        branch = continue_branch(
            system, y, increasing=False, events=events, control=control, max_points=_POINTS
        )
    except ContinuationError:
        return ()
    # One that broke off at an event may have others beyond.
    return branch.special if branch.end.finished or len(branch.points) == _POINTS else ()


def orbits_at(model: Any, n: int, amplitude: float) -> Any:
    """The n-T orbits at one Λ on the branch of the stable side, by contact duration."""
    check_index(n)
    if amplitude >= float(model.saddle_node(n).amplitude):
        special = continued(model, int(n), float(amplitude))
        points = [each.point for each in special if each.name == _HERE]
        if points:
            found = model.system(n).orbit(np.array(points))
            return found[np.argsort(found.contact_duration)]
    return both_sides(model, n, amplitude)


def both_sides(model: Any, n: int, amplitude: float) -> Any:
    """The orbits on both sides of the fold at one Λ, by contact duration; one at the fold."""
    system = model.system(n)
    y = np.array([system.point(model.orbit(n, amplitude, side)) for side in Side])
    # The larger phase, that of the stable side, first.
    y = np.unique(y[np.all(np.isfinite(y), axis=-1)], axis=0)[::-1]
    found = system.orbit(y)
    return found[np.argsort(found.contact_duration, kind="stable")]


def bifurcation(model: Any, n: ArrayLike, kind: Bifurcation) -> Any:
    """The orbits at a bifurcation: next to the corrected model's, or the first on the branch."""
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
    # A Λ of zero has no phase: the fold of an elastic contact, found anywhere near by rounding.
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
