r"""The cascade of flights between permanent contact and chattering, for a linear contact.

At Λ_SD permanent contact ends, and a T-periodic orbit with one flight per period begins
(``docs/closed-form.md``, section 4). As Λ grows, the contact after the landing oscillates higher,
until the ball touches the level of the table. There the contact opens: above this Λ the orbit has
one more flight. The new flight begins with zero length and changes the return map as the power 3/2
of Λ - Λ_k, so that the multipliers are continuous there and the orbit can be followed further.
Opening k, where flight k + 1 begins, is at ``E_k = ϖ² (Λ_k - Λ_SD)``.

For a stiff contact E_k has a limit. The ball leaves near the top of the table. Let s = ϖτ be the
time of the contact, measured from the top, δ = x/ϖ⁴ and Λ = 1 + C/ϖ². The motion is then ::

    x″ + 2ζx′ + x = C - s²/2   in contact,      x″ = C - s²/2   in flight

and does not depend on ϖ. Before the first flight the ball follows ``p(s) = E - (s - 2ζ)²/2``,
E = C + 1 - 2ζ², because the oscillation of the long contact has decayed. For large E the flights
chatter: the first landing has a speed of order E^{3/2} under an acceleration of order E, the speed
of flight k is r^k times as large, and the last flight is that whose duration is of order 1. Hence
``E_{k+1}/E_k → 1/r²``, up to a relative error of order k r^k, the ratio of the duration of k
contacts to that of the first flight.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from bouncing_ball.errors import require
from bouncing_ball.numerics.corrector import NewtonSettings, solve
from bouncing_ball.paper.contact.permanent_contact import permanent_contact_threshold
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.deviations import Deviation, Jacobian
from bouncing_ball.paper.motion.flight import Flight, table
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel

# Number of samples of an oscillation, among which its first maximum is bracketed.
_FINE = 400
# The search for the next opening starts above the last opening by this fraction, where the new
# flight is resolved.
_ABOVE = 1e-3
# The search for an opening goes up in steps of this factor.
_STEP = 1.2
_SETTINGS = NewtonSettings(max_iterations=10)
# Largest difference in time at which a motion is regarded as returning. A contact that opens
# elsewhere changes the times by far more, a considerable part of an oscillation.
_CLOSE = 1e-6


class Openings(NamedTuple):
    """Λ_k and the larger modulus of the multipliers at Λ_k; NaN where no opening was found."""

    amplitude: np.ndarray
    multiplier: np.ndarray


@dataclass(frozen=True)
class OpeningContacts:
    """T-periodic orbits with k flights whose long contact touches the table's level.

    The k flights and k contacts are 2k legs. The unknowns are y = (φ, Λ, t, T_0, …, T_{2k-2}, v_0,
    …, v_{2k-1}): the phase φ at the first release, Λ, the time t in the last contact at which the
    ball touches the level of the table, the durations T of all legs except the last contact, and δ′
    at the start of every leg. Each leg ends at δ = 0 with the δ′ of the next leg, and the last
    contact has δ = δ′ = 0 at t. It is continued in closed form whether it opens at t or not.
    ``law`` has a last axis of length 1, along which the legs are computed.
    """

    law: SpringDamper
    flights: int

    @cached_property
    def _linear(self) -> tuple[np.ndarray, np.ndarray]:
        """Two matrices of linear functions of y, for all legs and for the touch.

        The first, of shape (2k + 1, 4, unknowns), gives the duration, δ′ at the start, phase and Λ;
        2π is to be added to the duration of the last contact. The second, of shape (2k + 1, 2,
        unknowns), gives δ and δ′ at the end.
        """
        legs = 2 * self.flights
        # Each row of the unit matrix picks one unknown out of y.
        phase, lam, touch, *rest = np.eye(2 * legs + 2)
        times = np.array(rest[: legs - 1])
        speeds = rest[legs - 1 :]
        start_phases = [phase + times[:leg].sum(axis=0) for leg in range(legs)]
        by_leg = [
            (time, speed, start_phase, lam)
            for time, speed, start_phase in zip(
                [*times, -times.sum(axis=0)], speeds, start_phases, strict=True
            )
        ]
        until_touch = (touch, speeds[-1], start_phases[-1], lam)
        # Each leg ends with the speed at which the next begins, and the touch has δ′ = 0.
        end_speeds = np.array([*speeds[1:], speeds[0], 0 * phase])
        ends = np.stack([0 * end_speeds, end_speeds], axis=1)
        return np.array([*by_leg, until_touch]), ends

    def legs(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(δ, δ′) at the end of each leg and at the touch, shape (..., 2k + 1, 2), and their
        derivatives with respect to the duration of the leg, δ′ and the phase at its start, and Λ.
        """
        by_leg, _ = self._linear
        time, speed, phase, lam = np.moveaxis(np.inner(y, by_leg), -1, 0)
        time[..., -2] += 2 * np.pi
        # All legs are computed as contacts, and then every second one as a flight.
        flow = self.law.flow(time, 0.0, speed, phase, lam)
        states = np.stack(flow[:2], axis=-1)
        changes = flow.jacobian[..., [0, 2, 3, 4]]
        flights = slice(0, -1, 2)
        flown, flown_changes = _flights(
            time[..., flights], speed[..., flights], phase[..., flights], lam[..., flights]
        )
        states[..., flights, :] = flown
        changes[..., flights, :, :] = flown_changes
        return states, changes

    def system(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The defects of all equations, shape (..., 4k + 2), and their Jacobian."""
        states, changes = self.legs(y)
        by_leg, ends = self._linear
        defects = states - np.inner(y, ends)
        matrix = changes @ by_leg - ends
        return defects.reshape(y.shape), matrix.reshape(*y.shape, -1)

    def multiplier(self, y: np.ndarray) -> np.ndarray:
        """The larger modulus of the multipliers, with the leading shape of y."""
        states, changes = self.legs(y)
        one = np.ones(y.shape[:-1])
        monodromy = Jacobian(one, 0 * one, 0 * one, one)
        for leg in range(2 * self.flights):
            by_time, by_rate, by_phase, _ = np.moveaxis(changes[..., leg, :, :], -1, 0)
            rate = states[..., leg, 1]
            acceleration = by_time[..., 1]
            of_phase = Deviation(one, by_phase[..., 0], by_phase[..., 1])
            of_rate = Deviation(0 * one, by_rate[..., 0], by_rate[..., 1])
            change = Jacobian.of_columns(
                of_phase.to_event(rate, acceleration, 0), of_rate.to_event(rate, acceleration, 0)
            )
            monodromy = change.after(monodromy)
        return monodromy.spectral_radius()


def _flights(
    time: np.ndarray, speed: np.ndarray, phase: np.ndarray, lam: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(δ, δ′) at the end of flights, shape (..., 2), and their derivatives with respect to the
    duration, and to δ′, phase and Λ at the start, shape (..., 2, 4).
    """
    x, z = table(phase, lam)
    x1, z1 = table(phase + time, lam)
    height, rate, pull, _ = Flight(0.0, speed, x, z, lam).gap(time)
    # The contribution of the table to δ and δ′ is proportional to Λ.
    height_by_lam = (height - time * (speed - time / 2)) / lam
    rate_by_lam = (rate - speed + time) / lam
    of_height = [rate, time, x - x1 - z * time, height_by_lam]
    of_rate = [pull, 1 + 0 * time, z1 - z, rate_by_lam]
    changes = np.moveaxis(np.array([of_height, of_rate]), (0, 1), (-2, -1))
    return np.stack([height, rate], axis=-1), changes


@dataclass(frozen=True)
class _StiffContact:
    """A contact of the stiff limit from its start at t = 0: p plus Re(swing e^{root t}).

    ``aside`` is s - 2ζ at the start.
    """

    excess: float
    aside: float
    root: complex
    swing: complex

    @classmethod
    def of(cls, excess: float, zeta: float, place: float, speed: float) -> "_StiffContact":
        """The contact that starts at s = ``place`` with x′ = ``speed``."""
        root = _root(zeta)
        aside = place - 2 * zeta
        start = aside * aside / 2 - excess
        swing = complex(start, -(speed + aside + zeta * start) / root.imag)
        return cls(excess, aside, root, swing)

    def height(self, t: Any) -> Any:
        """x at times t since the start."""
        oscillation = np.real(self.swing * np.exp(self.root * t))
        return self.excess - (self.aside + t) ** 2 / 2 + oscillation

    def rate(self, t: Any) -> Any:
        """x′ at times t since the start."""
        return -self.aside - t + np.real(self.root * self.swing * np.exp(self.root * t))

    def first_maximum(self) -> float | None:
        """The time of the first maximum of x, None if x falls throughout."""
        time = self._samples()
        slope = self.rate(time)
        turns = np.flatnonzero((slope[:-1] > 0) & (slope[1:] <= 0))
        if not turns.size:
            return None
        before = turns[0]
        return brentq(self.rate, time[before], time[before + 1], xtol=1e-14)

    def end(self, top: float) -> float:
        """The time at which x returns to 0, before the first maximum at the time ``top``."""
        time = self._samples()
        rising = time[np.argmax(self.rate(time) > 0)]
        bottom = brentq(self.rate, 0.0, rising)
        return brentq(self.height, bottom, top, xtol=1e-14)

    def _samples(self) -> np.ndarray:
        return np.linspace(0, 3 * np.pi / self.root.imag, _FINE)


def _root(zeta: float) -> complex:
    """The root -ζ + i√(1 - ζ²) of s² + 2ζs + 1."""
    return complex(-zeta, np.sqrt((1 - zeta) * (1 + zeta)))


def _flight_time(place: float, pull: float, speed: float) -> float:
    """Duration of a flight of the stiff limit from s = ``place`` with x″ = ``pull`` and x′."""
    # The flight rises by t (speed + pull t/2 - place t²/6 - t³/24).
    zeros = np.roots([-1 / 24, -place / 6, pull / 2, speed])
    return min(x.real for x in zeros if abs(x.imag) < 1e-9 and x.real > 0)


def _landings(excess: float, zeta: float, most: int) -> list[tuple[float, tuple[float, ...]]]:
    """The landings of the stiff limit at E until a contact stays closed; at most ``most``.

    Each landing has the highest x in the contact that follows, and the unknowns of
    :class:`OpeningContacts`: the release, E, the time of the highest x, the durations of the
    earlier legs, and the speeds.
    """
    speed = np.sqrt(2 * excess)
    release = 2 * zeta - speed
    place = release
    times: list[float] = []
    speeds = [speed]
    found: list[tuple[float, tuple[float, ...]]] = []
    for _ in range(most):
        pull = excess + 2 * zeta * zeta - 1 - place * place / 2
        flight = _flight_time(place, pull, speed)
        speed = speed + flight * (pull - flight * (place / 2 + flight / 6))
        place = place + flight
        times.append(flight)
        speeds.append(speed)

        contact = _StiffContact.of(excess, zeta, place, speed)
        top = contact.first_maximum()
        if top is None:
            break
        highest = float(contact.height(top))
        found.append((highest, (release, excess, top, *times, *speeds)))
        if highest <= 0:
            break
        duration = contact.end(top)
        speed = contact.rate(duration)
        place = place + duration
        times.append(duration)
        speeds.append(speed)
    return found


@lru_cache
def _stiff_openings(zeta: float, most: int) -> list[np.ndarray]:
    """The unknowns of :class:`OpeningContacts` at the openings of the stiff limit, in its units and
    with E in place of Λ.
    """
    found: list[np.ndarray] = []

    def highest(excess: float) -> float:
        landings = _landings(excess, zeta, len(found) + 1)
        return landings[-1][0] if len(landings) > len(found) else -1.0

    high = 1e-3
    while len(found) < most:
        low = high
        while highest(high) < 0:
            low = high
            high = _STEP * high
        excess = brentq(highest, low, high, xtol=1e-13)
        found.append(np.array(_landings(excess, zeta, len(found) + 1)[-1][1]))
        high = excess * (1 + _ABOVE)
    return found


def stiff_openings(damping_ratio: float, most: int) -> np.ndarray:
    """The limits of E_1, E_2, … for ϖ → ∞, shape (most,).

    Raises
    ------
    ModelError
        If ζ is not in (0, 0.9], where the oscillation after a landing can be resolved.

    Examples
    --------
    >>> from bouncing_ball.paper.contact.damping import damping_ratio
    >>> stiff_openings(float(damping_ratio(0.85)), 3).round(2).tolist()
    [8.61, 22.51, 44.8]
    """
    zeta = float(damping_ratio)
    require(0 < zeta <= 0.9, zeta, "damping ratio ζ", "in (0, 0.9]")
    return np.array([y[1] for y in _stiff_openings(zeta, most)])


def openings(damping_ratio: ArrayLike, frequency_ratio: np.ndarray, most: int) -> Openings:
    """The openings of contacts with the displacement release, shape (ζ, most, ϖ).

    The openings are followed from the limit of stiff contacts down to the first ϖ at which Newton's
    method does not converge.

    Parameters
    ----------
    damping_ratio : array_like, shape (m,)
    frequency_ratio : ndarray, shape (N,)
        Increasing.
    most : int
        Number of openings.

    Examples
    --------
    >>> found = openings([0.05], np.array([20.0, 50.0]), 2)
    >>> bool(np.all(np.diff(found.amplitude, axis=1) > 0)), bool(np.all(found.multiplier < 1))
    (True, True)
    """
    zetas = np.asarray(damping_ratio, dtype=float)
    omega = np.flip(frequency_ratio)
    contact = SpringDamper(omega, zetas[:, np.newaxis])
    contact_of_legs = SpringDamper(omega[:, np.newaxis], zetas[:, np.newaxis, np.newaxis])
    threshold = permanent_contact_threshold(omega, contact.damping_ratio)
    stiff = [_stiff_openings(z, most) for z in zetas]
    found = np.full((2, most, *threshold.shape), np.nan)
    last = threshold
    for k in range(most):
        start = np.stack([one[k] for one in stiff])
        problem = OpeningContacts(contact_of_legs, k + 1)
        points = _followed(problem, omega, start, threshold)
        amplitude = points[..., 1]
        # If two openings coincide in Λ, only the first is kept.
        above_last = amplitude - last > _ABOVE * (amplitude - threshold)
        points = np.where(above_last[..., np.newaxis], points, np.nan)
        points[~_returns(contact, k + 1, points)] = np.nan
        last = points[..., 1]
        found[0, k] = last
        found[1, k] = problem.multiplier(points)
    amplitude, multiplier = found[..., ::-1].swapaxes(1, 2)
    return Openings(amplitude, multiplier)


def _returns(contact: SpringDamper, flights: int, points: np.ndarray) -> np.ndarray:
    """Whether the simulation from the first landing returns to this landing after one period.

    At the touch, rounding decides whether the contact opens, so that there may be one more impact.
    The simulation does not return if a contact opens elsewhere, where the equations continue it.
    """
    safe = np.where(np.isfinite(points), points, 1.0)
    release_phase = safe[..., 0]
    amplitude = safe[..., 1]
    first_flight = safe[..., 3]
    landing_rate = np.minimum(safe[..., 1 - 2 * flights], 0.0)
    phase = release_phase + first_flight
    velocity = landing_rate + table(phase, amplitude)[0]
    model = SpringDamperModel(contact)
    time = model.simulate(amplitude, phase, velocity, flights + 2).time
    late = np.abs(time[flights:] - time[0] - 2 * np.pi).min(axis=0)
    return np.isfinite(points[..., 0]) & (late < _CLOSE)


def _followed(
    problem: OpeningContacts, omega: np.ndarray, start: np.ndarray, threshold: np.ndarray
) -> np.ndarray:
    """The unknowns at the openings, followed from the stiff limit, shape (ζ, ϖ, unknowns).

    ``start`` are the unknowns in the stiff limit, shape (ζ, unknowns), ``omega`` falls, and
    ``threshold`` is Λ_SD, shape (ζ, ϖ).
    """
    size = start.shape[-1]
    legs = size // 2 - 1
    origin = np.zeros((*threshold.shape, size))
    origin[..., 0] = np.pi / 2
    origin[..., 1] = threshold
    # The powers of 1/ϖ by which φ, Λ, the times and the speeds are scaled. The first speed is
    # scaled like a time, which only changes the guesses for it.
    power = np.repeat([1.0, 2.0, 1.0, 3.0], [1, 1, legs + 1, legs - 1])
    unit = omega[:, np.newaxis] ** -power

    # In these units the points depend smoothly on 1/ϖ². The first place is the stiff limit.
    place = np.concatenate([[0.0], omega**-2.0])
    points = np.repeat(start[:, np.newaxis], place.size, axis=1)
    known = np.broadcast_to(place == 0, points.shape[:2])
    count = 0
    while known.sum() > count:
        count = known.sum()
        guess = np.where(known[..., np.newaxis], points, _extrapolated(points, place, known))
        with np.errstate(all="ignore"):
            solved = solve(problem.system, origin + unit * guess[:, 1:], _SETTINGS)
        forward = (solved.point[..., 2 : 3 + legs] > 0).all(axis=-1)
        known = np.insert(solved.converged & forward, 0, True, axis=1)
        known = np.logical_and.accumulate(known, axis=1)
        points[:, 1:] = np.where(known[:, 1:, np.newaxis], (solved.point - origin) / unit, np.nan)
    return origin + unit * points[:, 1:]


def _extrapolated(points: np.ndarray, place: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Straight lines over the places through the last two known points, shape of the points.

    If only one point is known, the line is constant.
    """
    rows = np.arange(len(points))
    last = known.sum(axis=1) - 1
    before = np.maximum(last - 1, 0)
    near = points[rows, last]
    far = points[rows, before]
    run = np.maximum(place[last] - place[before], np.finfo(float).tiny)
    away = (place - place[last, np.newaxis]) / run[:, np.newaxis]
    return near[:, np.newaxis] + away[..., np.newaxis] * (near - far)[:, np.newaxis]
