r"""The cascade of flights between permanent contact and chattering, for a linear contact.

At Λ_SD permanent contact ends, and a T-periodic orbit with one flight per period begins
(``docs/closed-form.md``, section 4). As Λ grows, the contact after the landing oscillates higher,
until the ball touches the level of the table. There the contact opens: above this Λ the orbit has
one more flight. The new flight begins with zero length and changes the return map as the power 3/2
of Λ - Λ_k, so that the multipliers are continuous there and the orbit can be followed further.
Opening k, where flight k + 1 begins, is at ``E_k = ϖ² (Λ_k - Λ_SD)``. It is the grazing of a
release of the orbit with k impacts in one period (:mod:`bouncing_ball.periodic`), whose equations
give its digits.

On compliant contacts these equations have several solutions, because the contact may close again
at a higher Λ and open once more. Opening k is the first one from below: Λ is raised from opening
k - 1 on, and a simulated ball stays on the orbit with k flights up to opening k.

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

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Motions
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.permanent_contact import permanent_contact_threshold
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.numerics.arrays import Batch
from bouncing_ball.numerics.corrector import NewtonSettings, newton
from bouncing_ball.periodic.orbits.balls import LAMBDA, Balls
from bouncing_ball.periodic.orbits.problem import OrbitEquations
from bouncing_ball.periodic.orbits.special import release_condition

# Number of samples of an oscillation, among which its first maximum is bracketed.
_FINE = 400
# The search for the next opening starts above the last opening by this fraction, where the new
# flight is resolved.
_ABOVE = 1e-3
# The search for an opening goes up in steps of this factor of E; on contacts of finite stiffness,
# which may close again, in smaller ones.
_STEP = 1.2
_SMALL_STEP = 1.05
# So many steps are tried at the same time, by balls that all start from the orbit below them; this
# takes little longer than one step.
_AHEAD = 8
# The search on a contact begins and ends at these shares of the E of the limit of stiff contacts.
_LOWEST, _HIGHEST = 0.02, 1.5
# An opening is bracketed within this fraction of E before its equations are solved.
_BRACKET = 1e-3
# Number of impacts for each flight of an orbit within which most balls are on it, and within which
# every ball must be.
_SOON = 12
_LATE = 40
# The same for any motion of a ball behind the top of the table.
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

    Opening k is the first from below: Λ is raised from opening k - 1, or from near Λ_SD, in steps
    of a twentieth of E, while simulated balls stay on the orbit with k flights in each period.
    It is NaN, with all openings above it, where the orbit ends or loses its stability before its
    contact opens, or where there is no stable orbit with k + 1 flights right above. Each contact is
    computed for itself, so that the openings do not depend on the other contacts. If the contact
    closes again within one step, the opening may be passed over.

    Parameters
    ----------
    damping_ratio : array_like, shape (m,)
    frequency_ratio : ndarray, shape (N,)
    most : int
        Number of openings.

    Examples
    --------
    >>> found = openings([0.05], np.array([20.0, 50.0]), 2)
    >>> bool(np.all(np.diff(found.amplitude, axis=1) > 0)), bool(np.all(found.multiplier < 1))
    (True, True)
    """
    zeta = np.asarray(damping_ratio, dtype=float)
    ratio, of_row = (x.ravel() for x in np.meshgrid(frequency_ratio, zeta))
    limits = np.stack([stiff_openings(z, most) for z in zeta])
    limits = np.repeat(limits, frequency_ratio.size, axis=0)
    found = Openings(*np.full((2, ratio.size, most), np.nan))
    rows = np.arange(ratio.size)
    orbits = _Followed.near_threshold(SpringDamper(ratio, of_row), _LOWEST * limits[:, 0])
    for k in range(most):
        if not rows.size:
            break
        orbits, there = orbits.raised(k + 1, _HIGHEST * limits[rows, k])
        rows = rows[there]
        orbits, opening, there = orbits.opened(k + 1)
        rows = rows[there]
        found.amplitude[rows, k], found.multiplier[rows, k] = opening
    shape = (zeta.size, frequency_ratio.size, most)
    return Openings(*(x.reshape(shape).swapaxes(1, 2) for x in found))


def balls_behind_the_top(law: SpringDamper, amplitude: np.ndarray) -> Motions:
    """The motions on which balls end that are set down slowly behind the top of the table."""
    phase, closing = _behind_the_top(law)
    velocity = amplitude * np.cos(phase) + closing
    return final_motions(ContactModel(law), amplitude, phase, velocity, impacts=_IMPACTS)


def _steps(excess: np.ndarray) -> np.ndarray:
    """The next steps of E, shape (steps, orbits)."""
    return excess * _SMALL_STEP ** np.arange(1.0, _AHEAD + 1)[:, np.newaxis]


def _behind_the_top(law: SpringDamper) -> tuple[np.ndarray, np.ndarray]:
    """φ and δ′ of a ball that is set down slowly behind the top of the table."""
    ratio = np.asarray(law.frequency_ratio)
    return np.pi / 2 + 3 / ratio, -0.1 / np.square(ratio)


@dataclass(frozen=True, repr=False)
class _Followed(Batch):
    """Orbits on a row of contacts whose Λ is raised.

    ``excess`` is E, and ``phase`` and ``closing`` are φ and δ′ < 0 of one of the impacts.
    """

    law: SpringDamper
    excess: np.ndarray
    phase: np.ndarray
    closing: np.ndarray

    @classmethod
    def near_threshold(cls, law: SpringDamper, excess: np.ndarray) -> Self:
        """Balls that are set down behind the top of the table, at small E."""
        return cls(law, excess, *_behind_the_top(law))

    @property
    def threshold(self) -> np.ndarray:
        """Λ_SD."""
        return permanent_contact_threshold(self.law.frequency_ratio, self.law.damping_ratio)

    @property
    def amplitude(self) -> np.ndarray:
        """Λ."""
        return self.threshold + self.excess / np.square(self.law.frequency_ratio)

    def at(self, excess: np.ndarray, flights: int, impacts: int = _LATE) -> tuple[Self, np.ndarray]:
        """The motions at other E of balls with the same impacts, and whether each is an orbit with
        this number of flights in each period. For each flight the ball has so many ``impacts``.
        """
        there = replace(self, excess=excess)
        level = there.amplitude
        velocity = level * np.cos(self.phase) + self.closing
        model = ContactModel(self.law)
        found = final_motions(model, level, self.phase, velocity, impacts=impacts * (flights + 1))
        closing = found.end_velocity - level * np.cos(found.end_phase)
        there = replace(there, phase=found.end_phase, closing=closing)
        return there, (found.periods == 1) & (found.impacts == flights)

    def raised(self, flights: int, top: np.ndarray) -> tuple[Self, np.ndarray]:
        """The orbits shortly below the lowest E at which they lose this number of flights, and the
        indices of the contacts that have such an E up to ``top``.
        """
        low, has = self.at(self.excess, flights)
        stopped = []
        rising = np.flatnonzero(has)
        while rising.size:
            rising = low.climb(rising, flights, top)
            risen = low.rise(rising, _steps(low.excess[rising]), flights)
            stopped.append(rising[risen == 0])
            rising = rising[risen > 0]
        known = np.sort(np.concatenate([rising, *stopped]))
        found = low.take(known)
        found.refine(flights)
        return found, known

    def climb(self, which: np.ndarray, flights: int, top: np.ndarray) -> np.ndarray:
        """Raise the orbits with these indices in steps of E while they are soon seen to be orbits
        with this number of flights; return the indices of those that are not, below ``top``.
        """
        stopped = []
        while which.size:
            risen = self.rise(which, _steps(self.excess[which]), flights, _SOON)
            below = self.excess[which] < top[which]
            stopped.append(which[(risen == 0) & below])
            which = which[(risen > 0) & below]
        return np.concatenate(stopped) if stopped else which

    def refine(self, flights: int) -> None:
        """Raise the orbits, which the next step of E ends, to a small fraction of E below that."""
        every = np.arange(self.excess.size)
        width = (_SMALL_STEP - 1) * self.excess
        while np.any(width > _BRACKET * self.excess):
            width = width / _AHEAD
            ahead = self.excess + np.arange(1, _AHEAD)[:, np.newaxis] * width
            self.rise(every, ahead, flights)

    def rise(
        self, which: np.ndarray, excess: np.ndarray, flights: int, impacts: int = _LATE
    ) -> np.ndarray:
        """Raise the orbits with these indices along increasing E, shape (steps, orbits), up to the
        first at which they are no orbits with this number of flights; return the numbers of steps.
        """
        steps = len(excess)
        there, same = self.take(np.tile(which, steps)).at(excess.ravel(), flights, impacts)
        risen = np.logical_and.accumulate(same.reshape(excess.shape)).sum(axis=0)
        moved = np.flatnonzero(risen)
        last = (risen[moved] - 1) * which.size + moved
        for name in ("excess", "phase", "closing"):
            getattr(self, name)[which[moved]] = getattr(there, name)[last]
        return risen

    def opened(self, flights: int) -> tuple[Self, Openings, np.ndarray]:
        """From orbits shortly below an opening those right above it, the openings, and the indices
        of the contacts on which an orbit with one more flight is there.
        """
        problem, guess = self._equations(flights)
        with np.errstate(all="ignore"):
            solved = newton(problem, guess, lambda y: release_condition(problem, y), _SETTINGS)
            multiplier = problem.monodromy(solved.point).spectral_radius()
        amplitude = problem.values(solved.point)[LAMBDA]
        excess = np.square(self.law.frequency_ratio) * (amplitude - self.threshold)
        # Another solution than the one that is bracketed is no answer.
        near = np.abs(excess - self.excess) <= 2 * _BRACKET * self.excess
        known = np.flatnonzero(solved.converged & (multiplier < 1) & near)
        above, more = self.take(known).at((1 + _ABOVE) * excess[known], flights + 1)
        there = known[more]
        return above.take(more), Openings(amplitude[there], multiplier[there]), there

    def _equations(self, flights: int) -> tuple[OrbitEquations, np.ndarray]:
        """The equations of the orbits along Λ, and these orbits as a guess.

        From permanent contact the phases and durations differ by the order of ϖ⁻¹, the velocities
        by ϖ⁻³ and Λ by ϖ⁻².
        """
        model = ContactModel(self.law)
        amplitude = self.amplitude
        velocity = amplitude * np.cos(self.phase) + self.closing
        impacts = model.simulate(amplitude, self.phase, velocity, flights)
        # The orbit starts with the impact after the longest contact, which ends in the next period.
        longest = impacts.contact_duration.argmax(axis=0)
        place = np.arange(1, flights + 1)[:, np.newaxis] + longest
        of_impacts = (
            impacts.phase[0] + impacts.time,
            impacts.relative_velocity,
            impacts.contact_duration,
        )
        phase, closing, duration = (
            np.take_along_axis(x, place % flights, axis=0).T for x in of_impacts
        )
        phase = phase - 2 * np.pi * (place < flights).T
        power = np.array([1.0, 3.0] * flights + [1.0] * flights + [2.0])
        unit = np.asarray(self.law.frequency_ratio)[:, np.newaxis] ** -power
        # The coordinate is arsinh Λ.
        unit[:, -1] /= np.hypot(1, self.threshold)
        turns = np.eye(flights, dtype=int)[-1]
        balls = Balls(model, self.threshold)
        problem = OrbitEquations(balls, flights, turns, (LAMBDA,), selects=True, unit=unit)
        return problem, problem.point(phase, closing, duration, amplitude=amplitude)
