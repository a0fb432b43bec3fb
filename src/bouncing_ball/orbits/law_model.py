"""A ball on a contact of any law: its n-T orbits, without a closed form.

An orbit starts from that of the corrected restitution model with the law's
signature at the speed of the restitution model's orbit, and is closed by Newton's method on
the contact's own equations, for many orbits at once. The bifurcations are the
zeros of the stability's test functions, on the system extended by them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.law_permanent_contact import permanent_contact
from bouncing_ball.contacts.law_signature import free_impact
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.continuation.branch import Branch, ContinuationError, continue_branch
from bouncing_ball.continuation.corrector import NewtonSettings, newton
from bouncing_ball.continuation.events import Event, LocationError, parameter_bound, vanishing
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.law_impacts import law_cycle, simulate
from bouncing_ball.motion.sequence import Cycle, ImpactSequence
from bouncing_ball.orbits import corrected_branch as corrected
from bouncing_ball.orbits.law_orbit import LawOrbit
from bouncing_ball.orbits.law_system import LawSystem
from bouncing_ball.orbits.model import Absence, ImpactModel, Route, Side
from bouncing_ball.orbits.orbit import Orbit, check_index
from bouncing_ball.orbits.stability import Bifurcation

# Speed of the orbit and its restitution depend on each other; each round gains a
# digit or two, and a start needs three.
_ROUNDS = 4
# Newton steps at a fixed Λ, and the last, over 1 + |y|.
_ITERATIONS = 25
_TOLERANCE = 1e-12
# A first step of Newton's method may be long next to the fold.
_LONGEST = 0.5
# A branch, for all orbits at one Λ: from so far above it, in not too many steps.
_ABOVE = 1.3
_STEPS = StepControl(initial=0.05, smallest=1e-3, largest=0.4, max_angle=0.25)
_POINTS = 300
_FARTHER = 4.0
# A fold so low is one of nearly elastic contacts: no step of a branch resolves it.
_LOWEST = 1e-4
# Farther above the fold than this there are steps in Λ, of at most so much in ln Λ.
_WALK, _STRIDE = 2.0, 0.2
_FOLD, _FLIP = Bifurcation
_HERE = "this amplitude"


def restitution_speed(n: ArrayLike, law: ContactLaw) -> tuple[np.ndarray, Instant]:
    """v = 2πn/(1 + r(v)), the impact speed of the restitution model's n-T orbits, and
    the law's signature there.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> speed, _ = restitution_speed(1, HuntCrossley(1e3, 0.0))
    >>> round(float(speed / np.pi), 12)
    1.0
    """
    period = 2 * np.pi * np.asarray(n, dtype=float)
    speed = period / 1.7 + np.zeros(law.shape)
    for _ in range(_ROUNDS):
        instant = free_impact(law, speed)
        speed = period / (1 + instant.restitution)
    return speed, free_impact(law, speed)


def _closed(n: np.ndarray, law: ContactLaw, guess: np.ndarray) -> np.ndarray:
    """Points (φ, z′_i, Λ) at the guesses' own Λ, in a row; NaN where none was found."""
    y, result = guess.copy(), np.full_like(guess, np.nan)
    active = np.flatnonzero(np.all(np.isfinite(guess), axis=1))
    for _ in range(_ITERATIONS):
        if not active.size:
            break
        residual, jacobian = LawSystem(n[active], law.take(active)).linearised(y[active])
        fine = np.all(np.isfinite(jacobian), axis=(1, 2))
        active, residual, jacobian = active[fine], residual[fine], jacobian[fine]
        a, b, c, d = (jacobian[:, i, j] for i in range(2) for j in range(2))
        with np.errstate(all="ignore"):
            first = (d * residual[:, 0] - b * residual[:, 1]) / (a * d - b * c)
            second = (a * residual[:, 1] - c * residual[:, 0]) / (a * d - b * c)
            step = np.stack([first, second], axis=1)
            size = np.linalg.norm(step, axis=1)
            step *= np.minimum(1.0, _LONGEST / size)[:, np.newaxis]
        y[active, :2] -= np.where(size[:, np.newaxis] > 0, step, 0.0)
        done = size <= _TOLERANCE * (1 + np.linalg.norm(y[active], axis=1))
        result[active[done]] = y[active[done]]
        active = active[~done & np.isfinite(size)]
    return result


def _walked(n: int, law: ContactLaw, first, level: float, lam: float, count: int) -> np.ndarray:
    """From a point at one Λ to that at another: far from the fold φ goes as 1/Λ; or NaN."""
    index, own = np.array([float(n)]), law.flat((1,))
    before = now = np.array(first)
    for high in level * (lam / level) ** (np.arange(1, count + 1) / count):
        gained = 1 / high - 1 / now[2]
        past = 1 / now[2] - 1 / before[2]
        slope = (now - before) / past if past else np.zeros(3)
        guess = np.append((now + slope * gained)[:2], high)
        before, now = now, _closed(index, own, guess[np.newaxis])[0]
        if np.any(np.isnan(now)):
            break
    return now


@dataclass(frozen=True, repr=False)
class LawModel(ImpactModel):
    """A ball on a contact of any law.

    Parameters
    ----------
    law : ContactLaw
        One law, or an array of laws.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
    >>> model = LawModel(Tsuji(500.0, tsuji_damping(0.85)))
    >>> limits = model.saddle_node(1).amplitude, model.period_doubling(1).amplitude
    >>> [round(float(x), 3) for x in limits]
    [0.246, 1.037]
    """

    law: ContactLaw

    name: ClassVar[str] = "contact-law"
    routes: ClassVar[frozenset[Route]] = frozenset({Route.CONTINUATION, Route.SIMULATION})
    orbit_type: ClassVar[type[Orbit]] = LawOrbit

    @property
    def label(self) -> str:
        """The law and its parameters."""
        return self.law.label

    def _row(self, n: ArrayLike, *more: ArrayLike):
        """Everything broadcast and in a row, with the law of each, and the shape."""
        check_index(n)
        arrays = (n, *more, np.zeros(self.law.shape))
        arrays = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in arrays))
        shape = arrays[0].shape
        return [x.reshape(-1) for x in arrays[:-1]], self.law.flat(shape), shape

    def _instants(self, n: np.ndarray, law: ContactLaw) -> Instant:
        """The signatures from which orbits start, in a row."""
        if law.shape:
            return restitution_speed(n, law)[1]
        index, where = np.unique(n, return_inverse=True)
        instant = _rigid_instant(type(law), tuple(law.fields()), tuple(index))
        return Instant(*(np.broadcast_to(x, index.shape)[where] for x in instant))

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> LawOrbit:
        """The n-T orbits at Λ on a side of the saddle-node; NaN where there is none."""
        (index, lam), law, shape = self._row(n, amplitude)
        instant = self._instants(index, law)
        psi = corrected.instant_phase(index, instant, lam, Side(side) == Side.STABLE)
        # Next to the fold the start may lie below it.
        psi = np.where(np.isnan(psi), corrected.saddle_node_phase(instant), psi)
        start = np.stack([psi - instant.delay, instant.delay - index * np.pi, lam], axis=1)
        y = _closed(index, law, start)
        on_side = self._is_on(Side(side), index, law, y)
        lost = np.flatnonzero(~on_side)
        if lost.size:
            fold = self._folds(index[lost], law.take(lost))
            y[lost] = np.nan
            lost = lost[lam[lost] >= fold]
            y[lost] = self._on_branches(index[lost], law.take(lost), lam[lost], Side(side))
        phase, impact = (y[:, k].reshape(shape) for k in range(2))
        return LawOrbit.at(n, self.law, lam.reshape(shape), phase, impact)

    def _folds(self, n: np.ndarray, law: ContactLaw) -> np.ndarray:
        """Λ of the saddle-nodes, in a row; each family of a single law once."""
        if law.shape:
            return LawModel(law).saddle_node(n).amplitude
        index, where = np.unique(n, return_inverse=True)
        return self.saddle_node(index).amplitude[where]

    def _is_on(self, side: Side, n, law: ContactLaw, y: np.ndarray) -> np.ndarray:
        """Whether points lie on a side of the fold."""
        orbit = LawSystem(n, law).orbit(y)
        test = _FOLD.test(*orbit.trace_and_determinant())
        return test > 0 if side == Side.STABLE else test < 0

    def _on_branches(self, n, law: ContactLaw, lam, side: Side) -> np.ndarray:
        """The points at Λ on a side of the fold, next to it along the branches; or NaN."""
        y = np.full((len(lam), 3), np.nan)
        for family in np.unique(n):
            rows = np.flatnonzero(n == family)
            # One branch for all orbits of a single law; else each has its own.
            for part in [rows] if not law.shape else rows[:, np.newaxis]:
                if part.size:
                    own = law.take(part[0])
                    y[part] = self._beyond(int(family), own, lam[part], side)
        return y

    def _beyond(self, n: int, law: ContactLaw, lam: np.ndarray, side: Side) -> np.ndarray:
        """The points at Λ: next to the fold along the branch, farther in steps from there."""
        y = np.full((len(lam), 3), np.nan)
        level = _WALK * float(LawModel(law).saddle_node(n).amplitude)
        near = lam <= level
        if near.any():
            y[near] = self._on_branch(n, law, lam[near], side)
        if near.all():
            return y
        start = LawModel(law).orbit(n, level, side)
        for k in np.flatnonzero(~near):
            count = int(np.ceil(np.log(lam[k] / level) / _STRIDE))
            y[k] = _walked(n, law, LawSystem(n, law).point(start), level, lam[k], count)
        return y

    def _on_branch(self, n: int, law: ContactLaw, lam: np.ndarray, side: Side) -> np.ndarray:
        branch = self._branch(n, law, float(np.max(lam)), farther=1.0)
        guess = np.full((len(lam), 3), np.nan)
        folds = branch.named(_FOLD) if branch else []
        if branch is None or not folds:
            return guess
        at = int(np.argmin(np.linalg.norm(branch.points - folds[0], axis=1)))
        points = branch.points[at::-1] if side == Side.STABLE else branch.points[at:]
        for k, level in enumerate(lam):
            over = np.flatnonzero((points[:-1, 2] < level) & (points[1:, 2] >= level))
            if over.size:
                left, right = points[over[0]], points[over[0] + 1]
                guess[k] = left + (level - left[2]) / (right[2] - left[2]) * (right - left)
        return _closed(np.full(len(lam), float(n)), law, guess)

    def _branch(
        self, n: int, law: ContactLaw, amplitude: float, farther: float = _FARTHER
    ) -> Branch | None:
        """The branch through Λ, from its stable side down to the fold and beyond."""
        system, index = LawSystem(n, law), np.array([n])
        instant = self._instants(index, law)
        start = max(amplitude, float(corrected.saddle_node(n, instant)[0])) * _ABOVE
        psi = corrected.instant_phase(index, instant, start)
        guess = np.stack([psi - instant.delay, instant.delay - n * np.pi, [start]], axis=1)
        y = _closed(index, law.flat((1,)), guess)[0]
        here = Event(_HERE, lambda y: y[..., -1] - amplitude)
        most = max(farther * amplitude, farther, _ABOVE * start)
        top = parameter_bound(most, upper=True, reason=f"Λ = {most:g}")
        bottom = parameter_bound(_LOWEST, upper=False, reason=f"Λ = {_LOWEST:g}")
        if np.any(np.isnan(y)) or y[-1] >= most:
            return None
        try:
            return continue_branch(
                system, y, increasing=False, events=(*system.events(), here, top, bottom),
                control=_STEPS, max_points=_POINTS,
            )  # fmt: skip
        except (ContinuationError, LocationError):
            return None

    def orbits(self, n: int, amplitude: float) -> LawOrbit:
        """The n-T orbits at one Λ on the branch of the stable side, by contact duration."""
        check_index(n)
        below = amplitude < float(self.saddle_node(n).amplitude)
        branch = None if below else self._branch(int(n), self.law, float(amplitude))
        points = branch.named(_HERE) if branch else []
        if not (points or below):
            sides = [self.orbit(n, amplitude, side) for side in Side]
            points = [LawSystem(n, self.law).point(o) for o in sides if o.exists]
        y = np.array(points).reshape(-1, 3)
        found = LawOrbit.at(n, self.law, y[:, 2], y[:, 0], y[:, 1])
        return found[np.argsort(found.contact_duration)]

    def absence(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> np.ndarray:
        """Why :meth:`orbit` finds none."""
        missing = ~self.orbit(n, amplitude, side).exists
        below = np.asarray(amplitude) < self.saddle_node(n).amplitude
        why = np.where(below, Absence.BELOW_SADDLE_NODE, Absence.NOT_FOUND)
        return np.where(missing, why, Absence.NONE)

    def saddle_node(self, n: ArrayLike) -> LawOrbit:
        """The orbits at the saddle-node; NaN where none was found."""
        return self._bifurcation(n, _FOLD)

    def period_doubling(self, n: ArrayLike) -> LawOrbit:
        """The orbits at the period doubling; NaN where none was found."""
        return self._bifurcation(n, _FLIP)

    def _bifurcation(self, n: ArrayLike, name: str) -> LawOrbit:
        (index,), law, shape = self._row(n)
        instant = self._instants(index, law)
        if name == _FOLD:
            lam = corrected.saddle_node(index, instant)
            psi = corrected.saddle_node_phase(instant)
        else:
            lam, psi = corrected.period_doubling(index, instant)
        guess = np.stack([psi - instant.delay, instant.delay - index * np.pi, lam], axis=1)
        kind: Any = type(law)
        rows = (
            _located(kind, tuple(law.take(k).fields()), index[k], name, tuple(guess[k]))
            for k in range(len(index))
        )
        y = np.array(list(rows)).reshape(-1, 3)
        lam, phase, impact = (y[:, k].reshape(shape) for k in (2, 0, 1))
        return LawOrbit.at(n, self.law, lam, phase, impact)

    def nearest(self, orbit: Any) -> Orbit:
        """There is no closed form.

        Raises
        ------
        ModelError
            Always.
        """
        raise ModelError(f"the orbits of {self.law.name} have no closed form")

    def system(self, n: int | np.ndarray) -> LawSystem:
        """The equations of the orbits, continued in Λ."""
        return LawSystem(n, self.law)

    def simulate(
        self, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
    ) -> ImpactSequence:
        """Impacts from a first one at phase φ, with absolute velocity z′_i before it."""
        return simulate(self.law, amplitude, phase, velocity, impacts)

    def cycle(self, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """The Poincaré map, from an impact (φ, δ′) to the next."""
        return law_cycle(self.law, amplitude, phase, relative_velocity)

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ up to which a steady contact is held all the time."""
        size = int(np.prod(self.law.shape))
        laws = (self.law.flat(self.law.shape).take(k) for k in range(size))
        found = [permanent_contact(law).amplitude for law in laws]
        return np.array(found).reshape(self.law.shape)


@lru_cache(maxsize=4096)
def _rigid_instant(kind: type[ContactLaw], values: tuple, index: tuple) -> Instant:
    """The signature of a single law at the speeds of the restitution model's orbits."""
    return restitution_speed(np.array(index), kind(*values))[1]


@lru_cache(maxsize=4096)
def _located(kind: type[ContactLaw], values: tuple, n: float, name: str, guess: tuple):
    """The bifurcation of a single law next to a guess; or else the first on the branch."""
    law = kind(*values)
    system = LawSystem(int(n), law)

    def function(y):
        return Bifurcation(name).test(*system.orbit(y).trace_and_determinant())

    if np.all(np.isfinite(guess)):
        settings = NewtonSettings(max_iterations=_ITERATIONS)
        found = newton(system, np.array(guess), vanishing(function), settings)
        if found.converged and found.point[-1] > 0:
            return found.point
    if name == _FOLD and guess[-1] < _LOWEST:
        return np.full(3, np.nan)
    branch = LawModel(law)._branch(int(n), law, float(np.nan_to_num(guess[-1], nan=1.0)))
    points = branch.named(name) if branch else []
    return points[-1 if name == _FLIP else 0] if points else np.full(3, np.nan)
