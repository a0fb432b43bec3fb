"""An n-T orbit of either model, or an array of orbits: one impact in n periods of the table.

The impact, which is the start of the contact, is at the phase φ of the table. The contact lasts for
τ_b, and the flight after it ends at the next impact, 2πn after the first one (Eqs. 18-20).
Heights and velocities are absolute unless they are called relative, which means relative to the
table: δ = z - w.

Two numbers decide about the stability, the trace and the determinant of the derivative of the
return map (φ, δ′) → (φ, δ′). It is the product of the derivative of the impact and of that of the
flight. Its eigenvalues are the Floquet multipliers. The orbit loses its stability at a saddle-node,
where a multiplier is +1 and ``1 - tr + det = 0``, or at a period doubling, where a multiplier is -1
and ``1 + tr + det = 0``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited import datasets
from bouncing_ball_beyond.inherited.errors import ModelError, require, shortened
from bouncing_ball_beyond.inherited.models.flight import Flight, flight_derivative, table
from bouncing_ball_beyond.inherited.models.model import Model
from bouncing_ball_beyond.inherited.models.simulation import next_impact
from bouncing_ball_beyond.inherited.numerics.arrays import Batch, as_numbers, in_words
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle

OBSERVABLES = (
    "amplitude",
    "phase",
    "contact_duration",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
    "max_height",
)
"""The seven observables of an orbit, with their names in datasets and on the command line."""

# The determinant of a contact that does not dissipate differs from 1 by rounding errors at most.
_ROUNDING = 8 * np.finfo(float).eps
# A highest point is searched in so many rounds of so many samples. The last steps are 16⁻⁵ of the
# first, and the error of the height is of the order of the square of the last step.
_SAMPLES = 33
_ROUNDS = 6
# A simulated cycle differs from the orbit by less than this part of its length and of its speed if
# both are the same; another landing or release differs by far more.
_SAME = 1e-6
# Samples of a contact, evenly and in geometric progression from its start on, because oscillations
# after an impact decay.
_WITHIN = np.union1d(np.linspace(0, 1, 160)[1:], np.geomspace(1e-6, 1, 160))
_NO_MAXIMUM = 1.0

Values = Any
"""A number for a single orbit, and an array for a row of them; no type of numpy is both."""


class Side(StrEnum):
    """Side of the saddle-node on which an orbit lies; another name raises ModelError."""

    STABLE = "stable"
    """The side that is stable next to the saddle-node, with the shorter contact."""
    UNSTABLE = "unstable"
    """The side that is unstable next to the saddle-node, with the longer contact."""

    @classmethod
    def _missing_(cls, value: object) -> Side:
        raise ModelError(f"unknown side {shortened(value)}: one of {', '.join(cls)}")


class Bifurcation(StrEnum):
    """The two bifurcations at which an orbit loses its stability along the branch."""

    SADDLE_NODE = datasets.SADDLE_NODE
    PERIOD_DOUBLING = datasets.PERIOD_DOUBLING

    def test(self, trace: ArrayLike, determinant: ArrayLike) -> np.ndarray:
        """``1 ∓ tr + det``: zero at the bifurcation, positive where the orbit is stable.

        Examples
        --------
        >>> [float(kind.test(1.5, 0.5)) for kind in Bifurcation]
        [0.0, 3.0]
        """
        multiplier = 1 if self is Bifurcation.SADDLE_NODE else -1
        return 1 - multiplier * np.asarray(trace) + np.asarray(determinant)


def check_index(n: ArrayLike) -> None:
    """Raise :class:`ModelError` unless the index of the family is a positive integer.

    Examples
    --------
    >>> check_index(1.5)
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: index of the family n = 1.5 is not a \
positive integer
    """
    name = "index of the family n"
    allowed = "a positive integer"
    index = as_numbers(n, name, allowed)
    whole = (index == np.floor(index)) & (index >= 1) & np.isfinite(index)
    require(whole, np.asarray(n), name, allowed)


@dataclass(frozen=True, repr=False, eq=False)
class Orbit(Batch):
    """n-T orbits of one model, or of a model for each; there is none where the phase is NaN.

    Parameters
    ----------
    model : Model
    n : int or array
        The orbit repeats after the time 2πn.
    amplitude : float or array
        Λ.
    phase : float or array
        φ, the table's phase at the impact.
    contact_duration : float or array
        τ_b, which is 0 for an impact with a restitution coefficient.
    impact_velocity : float or array
        The absolute velocity z′_i of the ball just before the impact.

    Examples
    --------
    The restitution model's orbit at φ = π/2, where an elastic ball bounces on the resting table:

    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = Orbit(rigid(restitution=1.0), 1, 0.5, np.pi / 2, 0.0, -np.pi)
    >>> found.bounce_velocity == np.pi, bool(found.stable), bool(found.admissible)
    (True, False, True)
    """

    model: Model
    n: Values
    amplitude: Values
    phase: Values
    contact_duration: Values
    impact_velocity: Values

    def __repr__(self) -> str:
        values = (
            f"  {name:<22}{in_words(getattr(self, name))}" for name in ("n", "model", *OBSERVABLES)
        )
        judged = (f"  {name:<22}{getattr(self, name)}" for name in ("stable", "admissible"))
        return "\n".join(["Orbit", *values, *judged])

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape to which the model and all numbers broadcast."""
        numbers = self.n, self.amplitude, self.phase, self.contact_duration, self.impact_velocity
        return np.broadcast_shapes(self.model.shape, *map(np.shape, numbers))

    @property
    def exists(self) -> Values:
        """Whether there is an orbit."""
        return np.isfinite(self.phase)

    @property
    def flight_time(self) -> Values:
        """L, the time from the release to the next impact.

        It is τ_2 - τ_b = 2πn - τ_b, because τ_i = 0 (Eq. 18) and τ_2 = τ_i + 2πn
        (Eq. 19); that z′_2 = z′_i (Eq. 20) is a condition on the orbit.
        """
        return 2 * np.pi * self.n - self.contact_duration

    @property
    def release_phase(self) -> Values:
        """The table's phase φ + τ_b at the release."""
        return self.phase + self.contact_duration

    @property
    def bounce_velocity(self) -> Values:
        """Absolute velocity at the release, z′_b = z′_i + 2πn - τ_b (Eq. 27)."""
        return self.impact_velocity + self.flight_time

    @property
    def relative_impact_velocity(self) -> Values:
        """δ′ = z′_i - w′_i at the start of contact, negative."""
        return self.impact_velocity - table(self.phase, self.amplitude)[0]

    @property
    def relative_bounce_velocity(self) -> Values:
        """δ′ = z′_b - w′_b at the release, positive."""
        return self.bounce_velocity - table(self.release_phase, self.amplitude)[0]

    @property
    def apparent_restitution(self) -> Values:
        """r_a = -(z′_b - w′_b)/(z′_i - w′_i) (Eq. 17); NaN where the impact grazes."""
        closing = np.asarray(self.relative_impact_velocity)
        return -self.relative_bounce_velocity / np.where(closing == 0, np.nan, closing)

    @property
    def bounce_height(self) -> Values:
        """Absolute height z_b at the release, from which the flight leads back to Λ sin φ."""
        _, landing = table(self.phase, self.amplitude)
        mean_velocity = (self.bounce_velocity + self.impact_velocity) / 2
        return landing - mean_velocity * self.flight_time

    @property
    def max_height(self) -> Values:
        """Greatest absolute height z over the orbit, in flight or in contact: max z of Eq. 37.

        The apex of a flight is at z_b + z′_b²/2, by Eq. 14 from the height z_b of the release. If
        it reaches Λ, it is the greatest height, because a ball in contact is below the table and
        thus below Λ. Otherwise the table may lift the ball higher during a long contact. In an
        orbit that is not admissible the ball may be above the table in contact, which is left out.
        """
        rising = np.maximum(self.bounce_velocity, 0.0)
        top = np.array(self.bounce_height + rising * rising / 2 + np.zeros(self.shape))
        lifted = np.flatnonzero((top < self.amplitude) & (np.asarray(self.contact_duration) > 0))
        if lifted.size:
            row = self.flat(self.shape).take(lifted)
            start = np.zeros(lifted.size)
            end = row.contact_duration + start
            of_contact = _highest(lambda time: contact_path(row, time)[0], start, end)
            top.flat[lifted] = np.maximum(top.flat[lifted], of_contact)
        return top[()]

    @property
    def stable(self) -> Values:
        """Whether both multipliers lie inside the unit circle: asymptotic stability.

        By Jury's conditions ``|det| < 1`` and ``1 ∓ tr + det > 0``. A determinant that is 1 up to
        rounding, as that of a contact that does not dissipate, is not below 1.
        """
        trace, determinant = trace_and_determinant(self)
        inside = np.abs(determinant) < 1 - _ROUNDING
        return inside & np.all([kind.test(trace, determinant) > 0 for kind in Bifurcation], axis=0)

    @property
    def admissible(self) -> Values:
        """Whether the simulated ball follows the orbit, without an earlier release or landing.

        The events of the simulation are certified. The result is False where there is no orbit.
        """
        row = self.flat(self.shape)
        closing = np.atleast_1d(row.relative_impact_velocity + np.zeros(row.shape))
        aloft = np.atleast_1d(row.flight_time + np.zeros(row.shape))
        found = np.zeros(closing.size, dtype=bool)
        may = np.flatnonzero((closing < 0) & (aloft > 0))
        if may.size:
            part = row.take(may)
            speed = closing[may]
            leg = next_impact(part.model, part.phase, speed, part.amplitude)
            period = 2 * np.pi * part.n
            late = np.abs(leg.time - period)
            longer = np.abs(leg.departure.duration - part.contact_duration)
            found[may] = (np.maximum(late, longer) < _SAME * period) & (leg.displacement == 0)
            found[may] &= np.abs(leg.velocity - speed) < _SAME * np.abs(speed)
        return found.reshape(self.shape)[()]


def _highest(
    height: Callable[[np.ndarray], np.ndarray], left: np.ndarray, right: np.ndarray
) -> np.ndarray:
    """The greatest values of functions of time, of which each has one maximum between two times.

    A round takes evenly spaced samples; the next one is between the neighbours of the highest.
    """
    share = np.linspace(0, 1, _SAMPLES)[:, np.newaxis]
    for _ in range(_ROUNDS):
        time = left + (right - left) * share
        value = height(time)
        middle = np.clip(value.argmax(axis=0), 1, _SAMPLES - 2)[np.newaxis]
        left = np.take_along_axis(time, middle - 1, axis=0)[0]
        right = np.take_along_axis(time, middle + 1, axis=0)[0]
    return value.max(axis=0)


# The motion.


def contact_path(orbit: Orbit, time: ArrayLike) -> tuple[Values, Values]:
    """Height z and velocity z′ at times 0 ≤ s ≤ τ_b in the contact (Eqs. 12 and 13)."""
    start = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude
    gap, rate = orbit.model.in_contact(np.asarray(time), *start)
    of_table, level = table(orbit.phase + np.asarray(time), orbit.amplitude)
    return gap + level, rate + of_table


def flight_path(orbit: Orbit, time: ArrayLike) -> tuple[Values, Values]:
    """Height and velocity in the flight, at times τ since the impact.

    In the paper, with the release at τ_b and the bouncing-off velocity z′_b ::

        z  = -(τ - τ_b)²/2 + (τ - τ_b) z′_b + Λ sin(τ_b + φ)    (14)
        z′ = -(τ - τ_b) + z′_b                                  (15)
    """
    since = np.asarray(time) - orbit.contact_duration
    velocity = orbit.bounce_velocity - since
    return orbit.bounce_height + (orbit.bounce_velocity + velocity) / 2 * since, velocity


def path(orbit: Orbit, time: ArrayLike) -> tuple[Values, Values]:
    """Height and velocity at any time since the impact, with the period 2πn.

    At the time of an impact without duration, the velocity is that after the impact.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> height, velocity = path(Orbit(rigid(restitution=1.0), 1, 0.5, np.pi / 2, 0.0, -np.pi), 0.0)
    >>> float(height), float(velocity) == np.pi
    (0.5, True)
    """
    since = np.mod(np.asarray(time, dtype=float), 2 * np.pi * orbit.n)
    duration = orbit.contact_duration
    touching = since < duration
    inside = contact_path(orbit, np.where(touching, since, 0.0))
    outside = flight_path(orbit, np.where(touching, duration, since))
    return np.where(touching, inside[0], outside[0]), np.where(touching, inside[1], outside[1])


def defect(orbit: Orbit) -> np.ndarray:
    """The largest defect of the three conditions of orbits: that of the release (Eq. 23), and those
    of the height and of the velocity of the next impact (Eqs. 25 and 26).

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> orbit = Orbit(rigid(restitution=1.0), 1, 0.5, np.pi / 2, 0.0, -np.pi)
    >>> bool(defect(orbit) < 1e-14)
    True
    """
    closing = orbit.relative_impact_velocity
    duration = orbit.contact_duration
    gap, rate = orbit.model.released(duration, orbit.phase, closing, orbit.amplitude)
    landed, at_landing, *_ = Flight(orbit.release_phase, gap, rate, orbit.amplitude).gap(
        orbit.flight_time
    )
    of_release = gap + orbit.model.lag * rate
    parts = np.broadcast_arrays(of_release, landed, at_landing - closing)
    return np.max(np.abs(parts), axis=0)


# Stability.


def monodromy(orbit: Orbit) -> np.ndarray:
    """Derivative of the return map (φ, δ′) → (φ, δ′) at the impact, shape (..., 2, 2)."""
    at_impact = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude
    of_impact = orbit.model.derivative(orbit.contact_duration, *at_impact)
    of_flight = flight_derivative(
        orbit.release_phase,
        orbit.flight_time,
        orbit.relative_impact_velocity,
        orbit.amplitude,
        orbit.model.lag,
    )
    return of_flight @ of_impact


@np.errstate(divide="ignore", invalid="ignore")  # where the ball grazes, and where there is none
def trace_and_determinant(orbit: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """Trace and determinant of the monodromy, of the shape of the orbits.

    The determinant is the contraction of areas in the contact. Without dissipation it is exactly 1,
    where rounding errors of the entries of the monodromy would decide about stability.

    Examples
    --------
    The orbit at φ = π/2 of the restitution model has the trace 1 + r² - (1 + r)² Λ:

    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = Orbit(rigid(restitution=1.0), 1, 0.5, np.pi / 2, 0.0, -np.pi)
    >>> [round(float(x), 12) for x in trace_and_determinant(found)]
    [0.0, 1.0]
    """
    matrix = monodromy(orbit)
    trace = matrix[..., 0, 0] + matrix[..., 1, 1]
    determinant = orbit.model.contraction(orbit.contact_duration)
    return trace, determinant + 0 * trace


def multipliers(orbit: Orbit) -> np.ndarray:
    """Floquet multipliers, complex, shape (..., 2); that of larger modulus comes first.

    The second multiplier is the determinant divided by the first. It thus keeps its digits where
    the two multipliers differ by orders of magnitude.
    """
    trace, determinant = trace_and_determinant(orbit)
    half = trace / 2
    with np.errstate(invalid="ignore"):  # an orbit that does not exist is NaN
        root = np.sqrt(half * half - determinant + 0j)
        first = half + np.where(half < 0, -1, 1) * root
        zero = first == 0
        second = np.where(zero, 0, determinant / np.where(zero, 1, first))
    return np.stack([first, second], axis=-1)


# Where a branch stops being admissible, and how far an orbit is from there.


def flight_margin(orbit: Orbit) -> np.ndarray:
    """The smallest local minimum of δ in the flight of each orbit of a row, 1 if there is none.

    Where it falls to 0 the flight grazes the table, and beyond there is an earlier impact.
    """
    speed = orbit.relative_bounce_velocity
    columns = orbit.release_phase, -orbit.model.lag * speed, speed, orbit.amplitude
    *start, time = np.broadcast_arrays(*columns, orbit.flight_time)
    return Flight(*start).lowest(time)


def release_margin(orbit: Orbit) -> np.ndarray:
    """Minus the largest local maximum of δ + κ δ′ within the contact of each orbit of a row, 1 if
    there is none.

    Where it falls to 0 the contact touches its release, and beyond there is an earlier release.
    """
    start = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude
    duration = orbit.contact_duration + np.zeros(orbit.shape)

    def height(time: np.ndarray) -> np.ndarray:
        gap, rate = orbit.model.in_contact(time, *start)
        return gap + orbit.model.lag * rate

    time = _WITHIN[:, np.newaxis] * duration
    value = height(time)
    inner = value[1:-1]
    is_top = (inner > value[:-2]) & (inner >= value[2:])
    top = np.where(is_top, inner, -np.inf).argmax(axis=0)[np.newaxis]
    left, right = (np.take_along_axis(time, top + k, axis=0)[0] for k in (0, 2))
    return np.where(is_top.any(axis=0), -_highest(height, left, right), _NO_MAXIMUM)


def difference(orbit: Orbit, other: Orbit) -> np.ndarray:
    """Largest difference of two orbits in Λ, φ, z′_i and, in units of its π-th part, in τ_b."""
    clock = np.pi / np.where(np.asarray(orbit.contact_duration) > 0, orbit.contact_duration, np.pi)
    parts = np.broadcast_arrays(
        np.asarray(orbit.amplitude) - other.amplitude,
        reduce_angle(np.asarray(orbit.phase) - other.phase),
        np.asarray(orbit.impact_velocity) - other.impact_velocity,
        (np.asarray(orbit.contact_duration) - other.contact_duration) * clock,
    )
    return np.max(np.abs(parts), axis=0)
