r"""A drop, computed in the steps of an engine, over all instants of the impact within a step.

The height of the body above the surface is z, its velocity v; p = -z is the penetration and
w = -v its rate. Everything is per unit of mass. Every engine here moves a body by::

    v⁺ = v - h g + h a,    z⁺ = z + h v⁺

and the engines differ in the acceleration a of the contact: at which instant it is taken, when it
ends, and by which law. Velocity Verlet (LAMMPS) is of this form as well, if
v is the velocity of half steps, by which its dampers act.

A ball that starts from rest at the height H has velocities -n g h. Let -s u h be its first height
below the surface, and u its speed then. Its start gives::

    u²/(2g) + u h (1/2 - s) = H,   u = g [√(τ² + 2H/g) - τ],   τ = h (1/2 - s)

where the offset s is anything between 0 and 1. All results are taken over many offsets, and over
small changes of the step and of the damping: in a contact of few steps r may be the same at all
offsets for one step, and not for a step beside it.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from bouncing_ball_contacts.units import Array

MOST_STEPS = 3000
"""In a contact. Finer steps change r by less than 0.001, and are not computed."""
SHORT_STEPS = 300
"""In a contact. r of these and of half as long ones leads to the limit of short steps to 0.001,
unless the weight presses the body in more than the impact does."""
# Below this share of the impact speed a body that creeps out of a contact counts as at rest. Its
# speed then also has to be nearly constant, which it is not where the body turns.
_REST = 2e-3
_CREEPING = 2e-5


@dataclass(frozen=True)
class Trials:
    """Variations of a contact, arrays of one shape.

    Attributes
    ----------
    at
        Offsets of the impact within a step.
    step, losses
        Factors of the step, and of the losses by damping and gravity.
    """

    at: Array
    step: Array
    losses: Array


def offsets(count: int) -> Array:
    """Return evenly spaced instants of the impact within a step."""
    return np.linspace(1e-3, 1 - 1e-3, count)


def exact(at: Array) -> Trials:
    """Return trials of the unchanged contact at offsets."""
    return Trials(at, np.ones_like(at), np.ones_like(at))


def nearby(steps: int, count: int) -> Trials:
    """Return trials of a contact and its neighbours, with `steps` steps and `count` offsets.

    The step over the contact time, h ω, differs by up to 1 %, and the damping ratio ζ and g/(ω v)
    by up to 0.5 %. This covers a mass, a stiffness and a step that are each off by 0.5 %, and a
    step alone that is off by 1 %.
    """
    step, losses, at = (
        every.ravel()
        for every in np.meshgrid(np.linspace(0.99, 1.01, steps), [0.995, 1.005], offsets(count))
    )
    return Trials(at, step, losses)


@dataclass(frozen=True)
class Law:
    """A contact force per unit of mass; the parameters are arrays, one entry for each contact.

    Laws of explicit steps have ``push``, the acceleration in m/s² at a penetration p > 0 in m and
    its rate w in m/s, and those of implicit steps ``implicit_velocity``, which is v⁺ of a step from
    z if v is the velocity without the contact.
    """

    stiffness: Array
    damping: Array
    drag = 0.0
    ahead = 0.0
    """Height in m below which a contact is found."""

    @property
    def deep(self) -> "Law":
        """Spring and damper of all points together, at the full impedance of MuJoCo."""
        return self

    @property
    def of_position(self) -> "Law":
        """Law whose velocity moves the body; another one in Gazebo only."""
        return self

    def rest(self, gravity: float) -> Array:
        """Return the depth at rest in m, where the spring carries the body: k p = g."""
        return gravity / self.stiffness

    def duration(self, speed: float) -> Array:
        """Return the order of magnitude of the contact time in s.

        It is at most 300/c. A strong damper stops the body long before it is released, and steps of
        1/3000 of 300/c are short for the damper.
        """
        time = np.pi / np.sqrt(self.stiffness) + 2 * self.damping / self.stiffness
        return np.minimum(time, 300 / np.maximum(self.damping, 1e-300))


class Linear(Law):
    """A spring and a damper: a = k p + c w, with k in 1/s² and c in 1/s; ratio ζ = c/(2√k)."""

    def push(self, p: Array, w: Array, gravity: Array) -> Array:
        return self.stiffness * p + self.damping * w

    def implicit_velocity(self, z: Array, v: Array, h: Array) -> Array:
        return (v - h * self.stiffness * z) / (1 + h * self.damping + h * h * self.stiffness)

    @classmethod
    def of_depth(cls, depth: Array, ratio: Array, speed: float) -> Self:
        """Return the contact with an undamped depth in m."""
        return cls((speed / depth) ** 2, 2 * ratio * speed / depth)


class HuntCrossley(Law):
    """Drake's a = k p (1 + d w)₊, with k in 1/s² and d in s/m; the ratio is d times the speed."""

    def push(self, p: Array, w: Array, gravity: Array) -> Array:
        return self.stiffness * p * np.maximum(1 + self.damping * w, 0.0)

    def implicit_velocity(self, z: Array, v: Array, h: Array) -> Array:
        # v⁺ = v + h k (-z - h v⁺)(1 - d v⁺) is a quadratic equation a v⁺² - b v⁺ + e = 0, whose
        # root of the smaller amount is the one with a force.
        a = h * h * self.stiffness * self.damping
        b = h * self.stiffness * (h - z * self.damping) + 1
        e = v - h * self.stiffness * z
        return 2 * e / (b + np.sqrt(np.maximum(b * b - 4 * a * e, 0.0)))

    def duration(self, speed: float) -> Array:
        return (np.pi + self.damping * speed) / np.sqrt(self.stiffness)

    @classmethod
    def of_depth(cls, depth: Array, ratio: Array, speed: float) -> Self:
        return cls((speed / depth) ** 2, ratio / speed)


class Hertz(Law):
    """Hertz with Tsuji's damper: a = K p^(3/2) + β √(5 K) p^(1/4) w, K in 1/(s² √m).

    Its r = exp(-πβ/√(1 - β²)) is the same at every speed; the ratio is β.
    """

    def push(self, p: Array, w: Array, gravity: Array) -> Array:
        root = np.sqrt(np.maximum(p, 0.0))
        return self.stiffness * root * p + self.damping * np.sqrt(5 * self.stiffness * root) * w

    def rest(self, gravity: float) -> Array:
        return (gravity / self.stiffness) ** (2 / 3)

    def duration(self, speed: float) -> Array:
        free = 2.943 * (1.25 / self.stiffness) ** 0.4 * speed**-0.2
        return free / np.sqrt(np.maximum(1 - self.damping**2, 0.01))

    @classmethod
    def of_depth(cls, depth: Array, ratio: Array, speed: float) -> Self:
        return cls(1.25 * speed**2 / depth**2.5, ratio)


@dataclass(frozen=True)
class Impedance(Law):
    """MuJoCo's contact: of N points with the impedance d(p) it is a = D (g + K d p + b w).

    D = N d/(q + (N - q) d) is the share of all points together. d rises from `low` at the surface
    to `high` at the depth `width`, by a power curve through the middle (`solimp`). The `edges` of a
    friction pyramid give q = μ² (1 + μ²)/(condim - 1), and an elliptic cone q = 1: each of its
    2 (condim - 1) edges has the regularizer 2 μ² (1 + μ²) (1 - d)/d.
    """

    points: int = 1
    low: float = 0.9
    high: float = 0.95
    width: float = 0.001
    middle: float = 0.5
    power: float = 2.0
    edges: float = 1.0

    def _impedance(self, p: Array) -> Array | float:
        if self.low == self.high:
            return self.high
        x = np.minimum(np.maximum(p / self.width, 0.0), 1.0)
        rising = x**self.power / self.middle ** (self.power - 1)
        falling = 1 - (1 - x) ** self.power / (1 - self.middle) ** (self.power - 1)
        return self.low + (self.high - self.low) * np.where(x <= self.middle, rising, falling)

    def _shared(self, d: Array | float) -> Array | float:
        return self.points * d / (self.edges + (self.points - self.edges) * d)

    def push(self, p: Array, w: Array, gravity: Array) -> Array:
        d = self._impedance(p)
        return self._shared(d) * (gravity + d * self.stiffness * p + self.damping * w)

    def rest(self, gravity: float) -> Array:
        """Return the depth at rest in m of one contact: the smallest one that carries the body."""
        if self.low == self.high:
            return gravity * (1 / self._shared(self.high) - 1) / (self.high * self.stiffness)
        depths = np.geomspace(1e-18, 1e18, 500)
        # Each time the interval becomes shorter by the number of its depths.
        for _ in range(5):
            carried = self.push(depths, np.zeros_like(depths), np.asarray(gravity)) >= gravity
            first = max(int(np.argmax(carried)), 1)
            depths = np.geomspace(depths[first - 1], depths[first], 500)
        return depths[0]

    @property
    def deep(self) -> Linear:
        shared = self._shared(self.high)
        return Linear(shared * self.high * self.stiffness, shared * self.damping)

    def duration(self, speed: float) -> Array:
        return self.deep.duration(speed)


@dataclass(frozen=True)
class Bullet(Linear):
    """Bullet's spring and damper, which aim at p = `slop`, and are found below the height `ahead`.

    Above the surface a body is stopped at it: v⁺ = (u + D C)/(1 + D) with D = h (h k + c) and
    C = -z/h there, and C = -k z/(h k + c) below.
    """

    slop: float = 0.0
    ahead: float = 0.0
    drag: float = 0.0
    """D in 1/s: the linear damping decelerates a body by D v (1 + |v|/(1 m/s))."""

    def rest(self, gravity: float) -> Array:
        return super().rest(gravity) + self.slop

    def implicit_velocity(self, z: Array, v: Array, h: Array) -> Array:
        gap = z + self.slop
        share = h * self.stiffness / (h * self.stiffness + self.damping)
        aim = -np.where(gap > 0, 1.0, share) * gap / h
        return aim + (v - aim) / (1 + h * (h * self.stiffness + self.damping))


@dataclass(frozen=True)
class Capped(Linear):
    """The spring and damper of Gazebo Classic, whose C = -k z/(h k + c) is at most `fastest`.

    The position moves as without `fastest`, and a body whose C at rest, g/(h k + c), is larger lies
    deeper than g/k.
    """

    fastest: float = math.inf
    step: float = math.inf

    @property
    def of_position(self) -> "Capped":
        return self if math.isinf(self.fastest) else replace(self, fastest=math.inf)

    def rest(self, gravity: float) -> Array:
        aim = gravity / (self.step * self.stiffness + self.damping)
        more = np.maximum(aim - self.fastest, 0.0) / (self.step * self.stiffness)
        return gravity / self.stiffness + more

    def implicit_velocity(self, z: Array, v: Array, h: Array) -> Array:
        both = h * self.stiffness + self.damping
        aim = np.minimum(-self.stiffness * z / both, self.fastest)
        return aim + (v - aim) / (1 + h * both)


@dataclass(frozen=True)
class SemiImplicit:
    """The force is that of the beginning of the step; `free` is the velocity without the contact.

    It never pulls unless the damper `pulls` (LAMMPS). The damper of
    Newton acts on `approach` only.
    """

    pulls: bool = False
    approach: bool = False

    def velocity(self, law: Any, z: Array, v: Array, free: Array, h: Array, g: Array) -> Array:
        rate = np.maximum(-v, 0.0) if self.approach else -v
        push = law.push(-z, rate, g)
        return np.where(z < 0, free + h * (push if self.pulls else np.maximum(push, 0.0)), free)


@dataclass(frozen=True)
class Implicit:
    """The force is that of the end of the step, and never pulls.

    If contacts are found `ahead`, it acts already in the step that would end below the surface.
    """

    ahead: bool = False

    def velocity(self, law: Any, z: Array, v: Array, free: Array, h: Array, g: Array) -> Array:
        touching = z + h * free < 0 if self.ahead else (z < 0) | (z < law.ahead)
        return np.where(touching, np.maximum(free, law.implicit_velocity(z, free, h)), free)


@dataclass(frozen=True)
class Drops:
    """Results of drops; the last axis is the axis of the trials.

    Attributes
    ----------
    restitution
        √(h′/h), or the ratio of the speeds without gravity.
    depth
        Largest penetration in m.
    peak
        Largest acceleration by the contact in m/s².
    """

    restitution: Array
    depth: Array
    peak: Array

    @property
    def mean(self) -> Array:
        return self.restitution.mean(axis=-1)

    def error(self, wanted: float) -> Array:
        """Return the largest deviation of r from the one that is wanted."""
        return np.abs(self.restitution - wanted).max(axis=-1)


def _beside(law: Law, trials: Trials) -> Law:
    """Return the law with an axis for the trials at the end of its arrays."""
    arrays = {
        name: value[..., None] for name, value in vars(law).items() if isinstance(value, np.ndarray)
    }
    damping = np.asarray(law.damping)[..., None] * trials.losses
    return replace(law, **{**arrays, "damping": damping})


def _drag_free(most: float, gravity: float, drag: float) -> tuple[Array, Array]:
    """Return speeds in m/s, and the speeds without drag from or to the same heights.

    The height is ∫ v dv/(g + D v (1 + v)); D is negative in a fall, which has a terminal speed.
    """
    if drag < 0:
        most = min(most, 0.9999 * (math.sqrt(0.25 - gravity / drag) - 0.5))
    v = np.linspace(0.0, most, 4001)
    rate = v / (gravity + drag * v * (1 + v))
    height = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2) * v[1]])
    return v, np.sqrt(2 * gravity * height)


# Bodies that have left are moved on with the others, and may be thrown ever faster.
@np.errstate(over="ignore", invalid="ignore")
def drop(
    law: Law,
    scheme: SemiImplicit | Implicit,
    step: Array | float,
    speed: float,
    gravity: float,
    trials: Trials,
) -> Drops:
    """Drop bodies from the height speed²/(2g), or throw them without gravity.

    Parameters
    ----------
    law : Law
        With parameters of the shape of ``step``.
    scheme : Scheme
    step : array
        Time steps in s.
    speed : float
        Of the impact, in m/s.
    gravity : float
        In m/s²; 0 for two free bodies.
    trials : Trials, of n drops
    """
    columns = _beside(law, trials)
    of_position = columns.of_position
    at = trials.at
    duration = columns.duration(speed)
    h = np.maximum(np.asarray(step, float)[..., None] * trials.step, duration / MOST_STEPS)
    g = gravity * trials.losses
    if gravity:
        height = speed**2 / (2 * g)
        lag = h * (0.5 - at)
        arrival = g * (np.sqrt(lag**2 + 2 * height / g) - lag)
        if law.drag:
            arrival = np.interp(arrival, *_drag_free(1.1 * speed, gravity, -law.drag)[::-1])
    else:
        height = np.zeros_like(at)
        arrival = speed + 0 * h * at
    # The step that ends below the surface is the second one, for contacts that are found ahead, or
    # the first one if the body falls for less than that.
    before = np.where(arrival > g * h, 2, 1)
    v = before * g * h - arrival
    z = (before - at) * arrival * h - (before - 1) * g * h * h
    fall = h * g
    # The law may have more values than there are steps.
    shape = np.shape(scheme.velocity(columns, z, v, v - fall, h, g))
    lowest = np.zeros(shape)
    peak = np.zeros(shape)
    # Velocity and height of those that have left.
    upward = np.zeros(shape)
    above = np.zeros(shape)
    inside = np.ones(shape, bool)
    # Of all bodies, until the first one ends: numbers are faster taken without a mask.
    counted: Any = True
    rose = np.broadcast_to(v > 0, shape)
    # A contact that is stable has ended, or has come to rest, within a few contact times.
    for _ in range(200 + int(np.max(12 * duration / h))):
        free = v - fall
        if law.drag:
            free = free - h * law.drag * v * (1 + np.abs(v))
        new = scheme.velocity(columns, z, v, free, h, g)
        np.maximum(peak, new - free, out=peak, where=counted)
        rises = new > 0
        ends = (rose > rises) & (z < 0)
        moves = new
        if of_position is not columns:
            moves = scheme.velocity(of_position, z, v, free, h, g)
        z = z + h * moves
        np.minimum(lowest, z, out=lowest, where=counted)
        leaves = inside & rises & (z >= 0)
        if leaves.any():
            leaves &= peak > 0
            np.copyto(upward, new, where=leaves)
            np.copyto(above, z, where=leaves)
            ends |= leaves
        is_slow = np.abs(new) < _REST * speed
        if is_slow.any():
            ends |= is_slow & (np.abs(new - v) < _CREEPING * speed)
        v = new
        rose = rises
        if ends.any():
            inside &= ~ends
            counted = inside
            if not inside.any():
                break
    if not gravity:
        return Drops(upward / speed, 0 - lowest, peak / h)
    if law.drag:
        upward = np.interp(upward, *_drag_free(2 * speed, gravity, law.drag))
    # The highest of the steps that follow: n more of them raise the body.
    n = np.floor(upward / fall)
    rise = np.maximum(above + n * h * upward - fall * h * n * (n + 1) / 2, 0.0)
    return Drops(np.sqrt(rise / height), 0 - lowest, peak / h)
