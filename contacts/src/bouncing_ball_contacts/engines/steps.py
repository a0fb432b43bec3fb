r"""One time step of an engine for a ball in contact, and balls that are followed by such steps.

An engine adds gravity to the velocity v of a ball, ``v - gh`` with its step h, then the contact
acts, if the ball is at x < 0 before the step, or if contacts are found ahead and it would be there
after the step, and moves the ball with the velocity v⁺ that results, ``x⁺ = x + h v⁺``. A contact
is therefore one function, which gives v⁺. All stiffnesses and dampings are per unit of mass, in
units of any time and length.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Protocol, Self

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball_beyond.models.laws.scales import rest
from bouncing_ball_contacts.engines.impedance import Impedance
from bouncing_ball_contacts.engines.scheme import Scheme, compensated

# A ball that has not left after so many steps, and as many times the duration of a contact, stays.
_FEW = 200
_LONG = 20
# Whether all balls are known to stay is asked after each of so many steps.
_OFTEN = 16


class Step(Protocol):
    """A time step of the size h of balls in contact."""

    @property
    def size(self) -> float: ...

    @property
    def ahead(self) -> int:
        """How many steps before the first one that begins at x < 0 are in contact: 0 or 1."""
        ...

    def depth_at_rest(self, gravity: float) -> float:
        """The penetration at which the contact carries a ball at rest."""
        ...

    def velocity(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        """v⁺ of balls in contact, with the velocity v ``before``, and v - gh where it is ``free``.

        All arrays have the same shape.
        """
        ...

    def keeps(self, place: np.ndarray, velocity: np.ndarray, gravity: float) -> Any:
        """Whether balls inside are known to stay inside for ever."""
        ...


def _bound(place: np.ndarray, velocity: np.ndarray, gravity: float, stiffness: float) -> np.ndarray:
    """Whether the energy v²/2 + gx + kx²/2 of balls at x < 0 is too small for x = 0.

    Implicit steps never raise this energy, because it is convex, nor does a damper.

    Examples
    --------
    >>> _bound(np.array([-1.0, -1.0]), np.array([0.0, 2.0]), gravity=10.0, stiffness=17.0)
    array([ True, False])
    """
    return velocity**2 / 2 + (gravity + stiffness / 2 * place) * place < 0


@dataclass(frozen=True)
class LinearStep:
    """A step with a spring and a damper: ``v⁺ = free - hk y`` with ``y = x + (c/k) v``, where x and
    v are those before the step, or after it in implicit steps.

    A contact with the force release acts only where y < 0.

    Examples
    --------
    >>> step = LinearStep.of(Scheme.IMPLICIT, 1.0, 0.2, Release.FORCE, 0.5)
    >>> step.matrix.round(3).tolist()
    [[0.815, 0.37], [-0.37, 0.741]]
    """

    scheme: Scheme
    stiffness: float
    damping: float
    release: Release
    size: float

    @classmethod
    def of(
        cls, scheme: Scheme, stiffness: float, damping: float, release: Release, size: float
    ) -> Self:
        """The step for a contact, with other parameters than its k and c if they compensate h.

        Raises
        ------
        ModelError
            If no engine with this scheme has the release.
        """
        if not release.is_linear and scheme.is_implicit:
            raise ModelError(f"no scheme is known for {scheme} with the release {release}")
        if scheme.is_compensated:
            stiffness, damping = compensated(stiffness, damping, size)
        return cls(scheme, stiffness, damping, release, size)

    def keeps(self, place: np.ndarray, velocity: np.ndarray, gravity: float) -> Any:
        return self.scheme.is_implicit and _bound(place, velocity, gravity, self.stiffness)

    def depth_at_rest(self, gravity: float) -> float:
        """g/k of the k of the step, which carries the ball alone, also where k compensates h."""
        return gravity / self.stiffness

    @property
    def ahead(self) -> int:
        return int(self.scheme.is_ahead)

    def grip(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        """y at the start of a step, or in implicit steps that after a step without contact."""
        lag = self.damping / self.stiffness
        if self.scheme.is_implicit:
            return place + (self.size + lag) * free
        rate = before if self.release.is_linear else np.minimum(before, 0.0)
        return place + lag * rate

    def _held(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        """v⁺ of balls on which the contact acts, also where it pulls."""
        h = self.size
        if self.scheme.is_implicit:
            slowing = 1 + h * self.damping + h * h * self.stiffness
            return (free - h * self.stiffness * place) / slowing
        return free - h * self.stiffness * self.grip(place, before, free)

    def velocity(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        held = self._held(place, before, free)
        if self.release.at_surface:
            return held
        return np.where(self.grip(place, before, free) < 0, held, free)

    @cached_property
    def matrix(self) -> np.ndarray:
        """The matrix of (x, v) of a step in contact without gravity, also where the force pulls."""
        place, before = np.eye(2)
        held = replace(self, release=Release.DISPLACEMENT)._held(place, before, before)
        return np.stack([place + self.size * held, held])

    @cached_property
    def ending(self) -> np.ndarray:
        """The numbers by which (x, v) is multiplied for what ends a contact where it is ≥ 0: y for
        the force release, otherwise x.
        """
        place, before = np.eye(2)
        return place if self.release.at_surface else self.grip(place, before, before)

    @cached_property
    def elastic(self) -> Self:
        """The step without the damper."""
        return replace(self, damping=0.0)


@dataclass(frozen=True)
class HuntCrossleyStep:
    """A step of Drake with the damping d of Hunt and Crossley.

    The force of a step is that of its end, ``f = k (p - h v⁺)(1 - d v⁺)`` with both factors not
    below 0, where p = -x is the penetration at its start, so that ::

        v⁺ = free + hk (p - h v⁺)(1 - d v⁺)

    is a quadratic equation for v⁺. Without damping the step is one of implicit Euler. As a linear
    damper of the parameters could, this one cannot take back the damping of the step, because it
    grows with the penetration.

    Source: Drake's documentation of its discrete contact approximations, "lagged" and "similar".
    """

    stiffness: float
    damping: float
    size: float
    ahead: ClassVar[int] = 0

    def keeps(self, place: np.ndarray, velocity: np.ndarray, gravity: float) -> Any:
        return _bound(place, velocity, gravity, self.stiffness)

    def depth_at_rest(self, gravity: float) -> float:
        return gravity / self.stiffness

    def velocity(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        p = np.maximum(-place, 0.0)
        pull = self.size * self.stiffness
        linear = 1 + pull * (p * self.damping + self.size)
        square = pull * self.size * self.damping
        start = pull * p + free
        root = np.sqrt(np.maximum(linear * linear - 4 * square * start, 0.0))
        held = 2 * start / (linear + root)
        # A ball that separates faster leaves the wall within the step, or its damper takes off all.
        fast = p / self.size
        if self.damping > 0:
            fast = np.minimum(fast, 1 / self.damping)
        return np.where(free < fast, held, free)


@dataclass(frozen=True)
class ImpedanceStep:
    """A step of MuJoCo with an impedance, with the force at its start: ``v⁺ = free + h f``, f ≥ 0.

    The law is in SI units: its ϖ is the natural frequency in rad/s, and its width is in m.
    """

    law: Impedance
    size: float
    ahead: ClassVar[int] = 0

    def keeps(self, place: np.ndarray, velocity: np.ndarray, gravity: float) -> Any:
        return False

    def depth_at_rest(self, gravity: float) -> float:
        # In units of g the weight is 1, and so is the force of the law that carries it.
        return rest(replace(self.law, width=self.law.width / gravity)) * gravity

    def velocity(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        # The load is what changes the velocity without a contact.
        loaded = self.law.under((before - free) / self.size)
        force = loaded.force(np.maximum(-place, 0.0), -before)
        return free + self.size * np.maximum(force, 0.0)


@dataclass(frozen=True)
class InstantStep:
    """A step of PyBullet with ``restitution``: a ball inside that approaches leaves at once, with
    r times the speed that it has after gravity, ``v⁺ = -r (v - gh)``.

    Source: Bullet's sequential impulse solver, read with the engine itself: heights of drops agree
    to rounding.
    """

    restitution: float
    size: float
    ahead: ClassVar[int] = 0

    def keeps(self, place: np.ndarray, velocity: np.ndarray, gravity: float) -> Any:
        return False

    def depth_at_rest(self, gravity: float) -> float:
        """0: the ball lies at the surface."""
        return 0.0

    def velocity(self, place: np.ndarray, before: np.ndarray, free: np.ndarray) -> np.ndarray:
        return np.where(free < 0, -self.restitution * free, free)


def step_of_law(law: ContactLaw, time_step: float) -> Step | None:
    """A time step in s of a ball on a contact law in SI units, with its stiffness per unit of mass;
    None if the steps of this law are not known.
    """
    if isinstance(law, Impedance):
        return ImpedanceStep(law, time_step)
    if isinstance(law, LinearHuntCrossley):
        return HuntCrossleyStep(float(law.stiffness), float(law.damping), time_step)
    return None


def patience(steps: float) -> int:
    """The number of steps after which a ball in a contact of so many steps is taken to stay."""
    return _FEW + int(_LONG * steps)


def until_outside(
    step: Step, place: np.ndarray, velocity: np.ndarray, most: int, gravity: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """x and v of balls at the first step that begins outside of the contact; of a ball that stays
    inside, at a step from which on it is known to stay, or after ``most``.

    Examples
    --------
    An elastic ball returns with the speed with which it came, and nearly at the same place:

    >>> step = LinearStep.of(Scheme.SEMI_IMPLICIT, 1.0, 0.0, Release.FORCE, 0.001)
    >>> x, v = until_outside(step, np.array([-1e-9]), np.array([-1.0]), 5000)
    >>> bool(0 <= x[0] < 0.001), round(float(v[0]), 5)
    (True, 1.0)
    """
    last = place, velocity
    for count, (x, v, _) in enumerate(steps_inside(step, place, velocity, most, gravity)):
        last = x, v
        if count % _OFTEN == 0 and np.all((x >= 0) | step.keeps(x, v, gravity)):
            break
    return last


def steps_inside(
    step: Step, place: np.ndarray, velocity: np.ndarray, most: int, gravity: float = 0.0
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """x, v and the force per unit of mass of each step, while a ball is inside; at most so many.

    A ball that has left stays where it is.
    """
    x = place
    v = velocity
    for _ in range(most):
        free = v - step.size * gravity
        # Without contact x + h free is the place after the step.
        first = np.minimum(x, x + step.size * free) if step.ahead else x
        inside = first < 0
        if not inside.any():
            return
        after = step.velocity(x, v, free)
        force = np.where(inside, after - free, 0.0) / step.size
        v = np.where(inside, after, v)
        x = np.where(inside, x + step.size * v, x)
        yield x, v, force
