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
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from bouncing_ball.beyond.simulation import simulate
from bouncing_ball.errors import require
from bouncing_ball.numerics.corrector import NewtonSettings, solve
from bouncing_ball.paper.contact.permanent_contact import permanent_contact_threshold
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.deviations import Deviation, Jacobian
from bouncing_ball.paper.motion.flight import Flight, table

# Number of samples of an oscillation, among which its first maximum is bracketed.
_FINE = 400
# The search for the next opening starts above the last opening by this fraction, where the new
# flight is resolved, and goes up in steps of this factor.
_ABOVE, _STEP = 1e-3, 1.2
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
        phase, lam, touch, *rest = np.eye(2 * legs + 2)
        times, speeds = np.array(rest[: legs - 1]), rest[legs - 1 :]
        lasts = [*times, -times.sum(axis=0), touch]
        starts = [phase + times[:leg].sum(axis=0) for leg in range(legs)]
        given = zip(lasts, [*speeds, speeds[-1]], [*starts, starts[-1]], strict=True)
        ends = np.array([*speeds[1:], speeds[0], 0 * phase])
        return np.array([(*x, lam) for x in given]), np.stack([0 * ends, ends], axis=1)

    def legs(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(δ, δ′) at the end of each leg and at the touch, shape (..., 2k + 1, 2), and their
        derivatives with respect to the duration of the leg, δ′ and the phase at its start, and Λ.
        """
        time, speed, phase, lam = np.moveaxis(np.inner(y, self._linear[0]), -1, 0)
        time[..., -2] += 2 * np.pi
        flow = self.law.flow(time, 0.0, speed, phase, lam)
        states, changes = np.stack(flow[:2], axis=-1), flow.jacobian[..., [0, 2, 3, 4]]
        flights = (..., slice(0, -1, 2))
        time, speed, phase, lam = time[flights], speed[flights], phase[flights], lam[flights]
        (x, z), (x1, z1) = table(phase, lam), table(phase + time, lam)
        height, rate, pull, _ = Flight(0.0, speed, x, z, lam).gap(time)
        # The contribution of the table to δ and δ′ is proportional to Λ.
        lifted, moved = (height - time * (speed - time / 2)) / lam, (rate - speed + time) / lam
        rows = [rate, time, x - x1 - z * time, lifted], [pull, 1 + 0 * time, z1 - z, moved]
        states[(*flights, slice(None))] = np.stack([height, rate], axis=-1)
        changes[(*flights, slice(None), slice(None))] = np.moveaxis(
            np.array(rows), (0, 1), (-2, -1)
        )
        return states, changes

    def system(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The defects of all equations, shape (..., 4k + 2), and their Jacobian."""
        (states, changes), (by_leg, ends) = self.legs(y), self._linear
        missed, matrix = states - np.inner(y, ends), changes @ by_leg - ends
        return missed.reshape(y.shape), matrix.reshape(*y.shape, -1)

    def multiplier(self, y: np.ndarray) -> np.ndarray:
        """The larger modulus of the multipliers, with the leading shape of y."""
        states, changes = self.legs(y)
        one = np.ones(y.shape[:-1])
        whole = Jacobian(one, 0 * one, 0 * one, one)
        for leg in range(2 * self.flights):
            by_time, by_rate, by_phase, _ = np.moveaxis(changes[..., leg, :, :], -1, 0)
            event = states[..., leg, 1], by_time[..., 1], 0
            ends = (
                Deviation(start, by[..., 0], by[..., 1]).to_event(*event)
                for start, by in ((one, by_phase), (0 * one, by_rate))
            )
            whole = Jacobian.of_columns(*ends).after(whole)
        return whole.spectral_radius()


def _held(t, excess: float, aside: float, root: complex, swing: complex):
    """x in the contact of the stiff limit: p plus the oscillation Re(swing e^{root t})."""
    return excess - (aside + t) ** 2 / 2 + np.real(swing * np.exp(root * t))


def _held_rate(t, excess: float, aside: float, root: complex, swing: complex):
    return -aside - t + np.real(root * swing * np.exp(root * t))


def _landings(excess: float, zeta: float, most: int) -> list[tuple[float, tuple[float, ...]]]:
    """The landings of the stiff limit at E until a contact stays closed; at most ``most``.

    Each landing has the highest x in the contact that follows, and the unknowns of
    :class:`OpeningContacts`: the release, E, the time of the highest x, the durations of the
    earlier legs, and the speeds.
    """
    root = complex(-zeta, np.sqrt((1 - zeta) * (1 + zeta)))
    speed = np.sqrt(2 * excess)
    place = release = 2 * zeta - speed
    found: list[tuple[float, tuple[float, ...]]] = []
    times, speeds = (), (speed,)
    for _ in range(most):
        pull = excess + 2 * zeta * zeta - 1 - place * place / 2
        # The flight rises by t (speed + pull t/2 - place t²/6 - t³/24).
        zeros = np.roots([-1 / 24, -place / 6, pull / 2, speed])
        flight = min(x.real for x in zeros if abs(x.imag) < 1e-9 and x.real > 0)
        speed = speed + flight * (pull - flight * (place / 2 + flight / 6))
        place = place + flight
        times, speeds = (*times, flight), (*speeds, speed)
        aside = place - 2 * zeta
        a = aside * aside / 2 - excess
        free = excess, aside, root, complex(a, -(speed + aside + zeta * a) / root.imag)
        time = np.linspace(0, 3 * np.pi / root.imag, _FINE)
        slope = _held_rate(time, *free)
        turns = np.flatnonzero((slope[:-1] > 0) & (slope[1:] <= 0))
        if not turns.size:
            break
        top = brentq(_held_rate, *time[turns[0] + np.arange(2)], args=free, xtol=1e-14)
        highest = float(_held(top, *free))
        found.append((highest, (release, excess, top, *times, *speeds)))
        if highest <= 0:
            break
        bottom = brentq(_held_rate, 0.0, time[np.argmax(slope > 0)], args=free)
        contact = brentq(_held, bottom, top, args=free, xtol=1e-14)
        speed, place = _held_rate(contact, *free), place + contact
        times, speeds = (*times, contact), (*speeds, speed)
    return found


@lru_cache
def _stiff_openings(zeta: float, most: int) -> list[np.ndarray]:
    """The unknowns of :class:`OpeningContacts` at the openings of the stiff limit, in its units and
    with E in place of Λ.
    """
    found: list[np.ndarray] = []

    def top(excess: float) -> float:
        landings = _landings(excess, zeta, len(found) + 1)
        return landings[-1][0] if len(landings) > len(found) else -1.0

    high = 1e-3
    while len(found) < most:
        low = high
        while top(high) < 0:
            low, high = high, _STEP * high
        excess = brentq(top, low, high, xtol=1e-13)
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
    zetas, omega = np.asarray(damping_ratio, dtype=float), np.flip(frequency_ratio)
    contact = SpringDamper(omega, zetas[:, np.newaxis])
    held = permanent_contact_threshold(omega, contact.damping_ratio)
    stiff = [_stiff_openings(z, most) for z in zetas]
    found, before = np.full((2, most, *held.shape), np.nan), held
    for k in range(most):
        start = np.stack([one[k] for one in stiff])
        problem = OpeningContacts(
            SpringDamper(omega[:, np.newaxis], zetas[:, np.newaxis, np.newaxis]), k + 1
        )
        points = _followed(problem, omega, start, held)
        # If two openings coincide in Λ, only the first is kept.
        new = points[..., 1] - before > _ABOVE * (points[..., 1] - held)
        points = np.where(new[..., np.newaxis], points, np.nan)
        points[~_returns(contact, k + 1, points)] = np.nan
        before = points[..., 1]
        found[:, k] = before, problem.multiplier(points)
    return Openings(*found[..., ::-1].swapaxes(1, 2))


def _returns(contact: SpringDamper, flights: int, points: np.ndarray) -> np.ndarray:
    """Whether the simulation from the first landing returns to this landing after one period.

    At the touch, rounding decides whether the contact opens, so that there may be one more impact.
    The simulation does not return if a contact opens elsewhere, where the equations continue it.
    """
    safe = np.where(np.isfinite(points), points, 1.0)
    phase, amplitude = safe[..., 0] + safe[..., 3], safe[..., 1]
    velocity = np.minimum(safe[..., 1 - 2 * flights], 0.0) + table(phase, amplitude)[0]
    time = simulate(contact, amplitude, phase, velocity, flights + 2).time
    late = np.abs(time[flights:] - time[0] - 2 * np.pi).min(axis=0)
    return np.isfinite(points[..., 0]) & (late < _CLOSE)


def _followed(
    problem: OpeningContacts, omega: np.ndarray, start: np.ndarray, held: np.ndarray
) -> np.ndarray:
    """The unknowns at the openings, followed from the stiff limit, shape (ζ, ϖ, unknowns)."""
    size = start.shape[-1]
    power = np.repeat([1.0, 2.0, 1.0, 3.0], [1, 1, size // 2, size - 2 - size // 2])
    unit = omega[:, np.newaxis] ** -power
    zero = np.zeros((*held.shape, size))
    zero[..., 0], zero[..., 1] = np.pi / 2, held
    place = np.concatenate([[0.0], omega**-2.0])
    points = np.repeat(start[:, np.newaxis], place.size, axis=1)
    known = np.broadcast_to(place == 0, points.shape[:2])
    rows, count = np.arange(len(start)), 0
    while known.sum() > count:
        # Extrapolate by a straight line in 1/ϖ² through the last two points.
        count, last = known.sum(), known.sum(axis=1) - 1
        before = np.maximum(last - 1, 0)
        near, far = points[rows, last], points[rows, before]
        run = np.maximum(place[last] - place[before], np.finfo(float).tiny)
        away = (place - place[last, np.newaxis]) / run[:, np.newaxis]
        line = near[:, np.newaxis] + away[..., np.newaxis] * (near - far)[:, np.newaxis]
        guess = np.where(known[..., np.newaxis], points, line)[:, 1:]
        with np.errstate(all="ignore"):
            solved = solve(problem.system, zero + unit * guess, _SETTINGS)
        forward = (solved.point[..., 2 : 2 + size // 2] > 0).all(axis=-1)
        known = np.insert(solved.converged & forward, 0, True, axis=1)
        known = np.logical_and.accumulate(known, axis=1)
        points[:, 1:] = np.where(known[:, 1:, np.newaxis], (solved.point - zero) / unit, np.nan)
    return zero + unit * points[:, 1:]
