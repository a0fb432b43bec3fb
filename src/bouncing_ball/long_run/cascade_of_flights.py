r"""The cascade of flights between permanent contact and chattering, for a linear contact.

At Λ_SD permanent contact ends, and a T-periodic orbit with one flight per period begins
(``docs/closed-form.md``, section 4). As Λ grows, the contact after the landing oscillates higher,
until the ball touches the level of the table. There the contact opens: above this Λ the orbit has
one more flight. The new flight begins with zero length and changes the return map as the power 3/2
of Λ - Λ_k, so that the multipliers are continuous there and the orbit can be followed further.
Opening k, where flight k + 1 begins, is at ``E_k = ϖ² (Λ_k - Λ_SD)``. It is the grazing of a
release of the orbit with k impacts in one period (:mod:`bouncing_ball.periodic`), and is
found with its equations, from the limit of stiff contacts on.

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
from functools import lru_cache
from typing import Any, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Motions
from bouncing_ball.models.permanent_contact import permanent_contact_threshold
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper_model import SpringDamperModel
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.corrector import NewtonSettings, newton
from bouncing_ball.periodic.orbits.balls import LAMBDA, Balls
from bouncing_ball.periodic.orbits.problem import PeriodicOrbits
from bouncing_ball.periodic.orbits.release import release_condition

# Number of samples of an oscillation, among which its first maximum is bracketed.
_FINE = 400
# The search for the next opening starts above the last opening by this fraction, where the new
# flight is resolved.
_ABOVE = 1e-3
# The search for an opening goes up in steps of this factor.
_STEP = 1.2
# The guesses at the next ϖ: the number of steps, and the share of the slope between the last two ϖ.
# On a weakly damped contact the slope of coarse steps is that of the oscillation that is left from
# the last contact, and may have the wrong sign.
_GUESSES = ((1, 1.0), (1, 0.0), (1, -1.0), (3, 1.0))
# Number of impacts within which a ball must be on its orbit.
_IMPACTS = 250
_SETTINGS = NewtonSettings(max_iterations=8)


class Openings(NamedTuple):
    """Λ_k and the larger modulus of the multipliers at Λ_k; NaN where no opening was found."""

    amplitude: np.ndarray
    multiplier: np.ndarray


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
        return scipy.optimize.brentq(self.rate, time[before], time[before + 1], xtol=1e-14)

    def end(self, top: float) -> float:
        """The time at which x returns to 0, before the first maximum at the time ``top``."""
        time = self._samples()
        rising = time[np.argmax(self.rate(time) > 0)]
        bottom = scipy.optimize.brentq(self.rate, 0.0, rising)
        return scipy.optimize.brentq(self.height, bottom, top, xtol=1e-14)

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


def _landings(excess: float, zeta: float, most: int) -> list[tuple[float, np.ndarray]]:
    """The landings of the stiff limit at E until a contact stays closed; at most ``most``.

    Each has the highest x in the contact that follows, and the unknowns of an orbit with so many
    impacts if this contact lasts until the next release: s and x′ at each landing, the durations of
    the contacts, less the period for the last one, and E.
    """
    speed = np.sqrt(2 * excess)
    release = 2 * zeta - speed
    place = release
    states: list[float] = []
    durations: list[float] = []
    found: list[tuple[float, np.ndarray]] = []
    for _ in range(most):
        pull = excess + 2 * zeta * zeta - 1 - place * place / 2
        flight = _flight_time(place, pull, speed)
        speed = speed + flight * (pull - flight * (place / 2 + flight / 6))
        place = place + flight
        states += [place, speed]

        contact = _StiffContact.of(excess, zeta, place, speed)
        top = contact.first_maximum()
        if top is None:
            break
        highest = float(contact.height(top))
        found.append((highest, np.array([*states, *durations, release - place, excess])))
        if highest <= 0:
            break
        duration = contact.end(top)
        speed = contact.rate(duration)
        place = place + duration
        durations.append(duration)
    return found


@lru_cache
def _stiff_openings(zeta: float, most: int) -> list[np.ndarray]:
    """The unknowns of :func:`_landings` at the openings of the stiff limit."""
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
        excess = scipy.optimize.brentq(highest, low, high, xtol=1e-13)
        found.append(_landings(excess, zeta, len(found) + 1)[-1][1])
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
    >>> from bouncing_ball.models.damping import damping_ratio
    >>> stiff_openings(float(damping_ratio(0.85)), 3).round(2).tolist()
    [8.61, 22.51, 44.8]
    """
    zeta = float(damping_ratio)
    require(0 < zeta <= 0.9, zeta, "damping ratio ζ", "in (0, 0.9]")
    return np.array([y[-1] for y in _stiff_openings(zeta, most)])


def openings(damping_ratio: ArrayLike, frequency_ratio: np.ndarray, most: int) -> Openings:
    """The openings of contacts with the displacement release, shape (ζ, most, ϖ).

    The openings are followed from the limit of stiff contacts down to the first ϖ at which no
    stable orbit is found, or at which simulated balls show that it is not the next opening.

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
    zeta = np.asarray(damping_ratio, dtype=float)
    shape = (zeta.size, most, frequency_ratio.size)
    found = Openings(np.full(shape, np.nan), np.full(shape, np.nan))
    contact = SpringDamper(frequency_ratio, zeta[:, np.newaxis])
    for k in range(most):
        limit = np.stack([_stiff_openings(z, most)[k] for z in zeta])
        place = _Place.at_limit(limit)
        for j in range(frequency_ratio.size - 1, -1, -1):
            place = _next(zeta, frequency_ratio[j], place)
            found.amplitude[:, k, j], found.multiplier[:, k, j] = place.opening
    known = _is_next(contact, found.amplitude)
    # Each opening requires the last one. From the first ϖ on at which another opening is found, it
    # is no longer followed.
    known = np.logical_and.accumulate(known, axis=1)
    known = np.logical_and.accumulate(known[..., ::-1], axis=-1)[..., ::-1]
    return Openings(*(np.where(known, x, np.nan) for x in found))


def _is_next(contact: SpringDamper, amplitude: np.ndarray) -> np.ndarray:
    """Whether simulated balls on contacts, shape (ζ, ϖ), have k flights from the last opening up to
    opening k, and one more above it; of the shape of the openings, (ζ, k, ϖ).
    """
    threshold = permanent_contact_threshold(contact.frequency_ratio, contact.damping_ratio)
    threshold = threshold[:, np.newaxis]
    last = np.concatenate([threshold, amplitude[:, :-1]], axis=1)
    # If two openings coincide in Λ, only the first is kept.
    above = _ABOVE * (amplitude - threshold)
    exists = np.nonzero(amplitude - last > above)
    zeta, k, ratio = exists
    low, high, aside = (x[exists] for x in (last, amplitude, above))
    places = np.stack([low + 2 * aside, (low + high) / 2, high - aside, high + aside])
    found = balls_behind_the_top(contact[zeta, ratio], places)
    flights = np.add.outer([0, 0, 0, 1], k + 1)
    is_next = np.zeros(amplitude.shape, dtype=bool)
    is_next[exists] = np.all((found.periods == 1) & (found.impacts == flights), axis=0)
    return is_next


def balls_behind_the_top(law: SpringDamper, amplitude: np.ndarray) -> Motions:
    """The motions on which balls end that are set down slowly behind the top of the table."""
    phase = np.pi / 2 + 3 / law.frequency_ratio
    velocity = amplitude * np.cos(phase) - 0.1 / np.square(law.frequency_ratio)
    return final_motions(SpringDamperModel(law), amplitude, phase, velocity, impacts=_IMPACTS)


class _Place(NamedTuple):
    """The openings of several contacts at one ϖ; NaN where none was found.

    ``scaled`` are the unknowns, measured from their limits in units of their powers of ϖ, shape (ζ,
    unknowns); they depend on 1/ϖ² with the slope ``rise``. ``opening`` has Λ_k and the larger
    modulus of the multipliers, each of shape (ζ,).
    """

    ratio: float
    scaled: np.ndarray
    rise: np.ndarray
    opening: Openings

    @classmethod
    def at_limit(cls, limit: np.ndarray) -> Self:
        """The place ϖ → ∞."""
        none = np.ones(len(limit))
        return cls(np.inf, limit, np.zeros_like(limit), Openings(none, none))

    @classmethod
    def unknown(cls, ratio: float, shape: tuple[int, ...]) -> Self:
        """A place without openings, for unknowns of this shape."""
        none = np.full(shape, np.nan)
        openings = np.full((2, shape[0]), np.nan)
        return cls(ratio, none, none.copy(), Openings(*openings))

    def store(self, which: np.ndarray, part: Self) -> None:
        """Fill in the openings of the contacts with these indices."""
        self.scaled[which] = part.scaled
        self.rise[which] = part.rise
        for whole, values in zip(self.opening, part.opening, strict=True):
            whole[which] = values


def _next(zeta: np.ndarray, ratio: float, place: _Place) -> _Place:
    """The openings at the next smaller ϖ: for each contact those of the first guess that leads to a
    stable orbit.
    """
    found = _Place.unknown(ratio, place.scaled.shape)
    left = np.flatnonzero(np.isfinite(place.opening.amplitude))
    for parts, share in _GUESSES:
        if not left.size:
            break
        there = pick(place, left)
        there = there._replace(rise=share * there.rise)
        between = np.linspace(place.ratio**-2.0, ratio**-2.0, parts + 1)[1:-1] ** -0.5
        for step in (*between, ratio):
            there = _stepped(zeta[left], step, there)
        known = np.isfinite(there.opening.amplitude)
        found.store(left[known], pick(there, known))
        left = left[~known]
    return found


def _stepped(zeta: np.ndarray, ratio: float, place: _Place) -> _Place:
    """The openings at ϖ by Newton's method from the line through those at another ϖ."""
    orbits, origin = _scaled(zeta, ratio, place.scaled.shape[-1] // 3)
    ahead = ratio**-2.0 - place.ratio**-2.0
    guess = origin + orbits.unit * (place.scaled + ahead * place.rise)
    with np.errstate(all="ignore"):
        solved = newton(orbits, guess, lambda y: release_condition(orbits, y), _SETTINGS)
        multiplier = orbits.monodromy(solved.point).spectral_radius()
    # With a multiplier above 1 the orbit has turned back at a saddle-node.
    exists = solved.converged & (multiplier < 1)
    y = np.where(exists[:, np.newaxis], solved.point, np.nan)
    scaled = (y - origin) / orbits.unit
    opening = Openings(orbits.values(y)[LAMBDA], np.where(exists, multiplier, np.nan))
    return _Place(ratio, scaled, (scaled - place.scaled) / ahead, opening)


def _scaled(
    zeta: np.ndarray, frequency_ratio: float, impacts: int
) -> tuple[PeriodicOrbits, np.ndarray]:
    """The orbits with k impacts in one period, and the origin of their unknowns in the stiff limit.

    From it the phases and durations differ by the order of ϖ⁻¹, the velocities by ϖ⁻³ and Λ by
    ϖ⁻².
    """
    threshold = permanent_contact_threshold(frequency_ratio, zeta)
    model = SpringDamperModel(SpringDamper(np.full(zeta.shape, frequency_ratio), zeta))
    balls = Balls(model, threshold)
    power = np.array([1.0, 3.0] * impacts + [1.0] * impacts + [2.0])
    unit = np.broadcast_to(frequency_ratio**-power, (zeta.size, power.size)).copy()
    # The coordinate is arsinh Λ.
    unit[:, -1] /= np.hypot(1, threshold)
    turns = np.eye(impacts, dtype=int)[-1]
    orbits = PeriodicOrbits(balls, impacts, turns, (LAMBDA,), selects=True, unit=unit)
    none = np.zeros((zeta.size, impacts))
    periods = np.broadcast_to(2 * np.pi * turns, none.shape)
    return orbits, orbits.point(none + np.pi / 2, none, periods, amplitude=threshold)
