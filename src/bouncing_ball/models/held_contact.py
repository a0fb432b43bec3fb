r"""Contacts with a spring and a damper on any table, also beside a drag or another spring.

In the notation of :mod:`bouncing_ball.models.suspension` a flight obeys ``p″ + l p′ + q p = b``
with δ = p - W. In contact the spring and the damper of the contact act as well, on δ alone::

    δ″ + (l + 2ζϖ) δ′ + (q + ϖ²) δ = b - (W″ + l W′ + q W)

This is a flight of the same form, with the loss l + 2ζϖ, the stiffness q + ϖ² and, in place of W,
the periodic motion W_c, whose harmonics are those of W times ::

    (q - k² + ilk)/(q + ϖ² - k² + i(l + 2ζϖ)k)

The forced response therefore is a sum over the harmonics of the table, and the bounds of
:mod:`bouncing_ball.models.linear_flight` hold in contact too. The release is the first upward zero
of y = δ + κ δ′, as in :mod:`bouncing_ball.models.linear_contact`. With P = p + κ p′, the energy of
its free oscillation never rises, so that ::

    y ≤ b/Q + R + S,    R = √((P - b/Q)² + P′²/Q),    S = -(W_c + κ W_c′),    Q = q + ϖ²

from any time on. A contact in which the right-hand side stays below 0 for the largest S never ends;
until S reaches its complement the search may pass over any number of oscillations. The largest S is
found to the last digits by bisection with a bound of its second derivative. It also gives the
threshold of permanent contact, Λ = -b/(Q max S/Λ).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball.errors import ParameterError
from bouncing_ball.models.contacts_and_flights import Departure, Impact
from bouncing_ball.models.deviations import Deviation, Released
from bouncing_ball.models.linear_contact import PATIENCE, ROUNDING, LinearContactDynamics
from bouncing_ball.models.linear_flight import LinearFlight
from bouncing_ball.models.sequence import Status
from bouncing_ball.models.suspension import Suspension
from bouncing_ball.models.waveform import Waveform, largest
from bouncing_ball.numerics.elementary import exponential, sine_and_cosine
from bouncing_ball.numerics.first_zero import Derivatives, Motion, Zero, first_zero

# The result of a skip precedes the crossing by more than the rounding error of the crossing.
_BEFORE = 1e-9
_TURN = 2 * np.pi
# A harmonic that is nearer to an undamped resonance than this has no periodic motion W_c within the
# range of doubles.
_RESONANCE = 1e-8


@dataclass(frozen=True, repr=False)
class Held(Suspension):
    """What moves a ball in contact: the spring and the damper, beside what moves it in flight.

    Parameters
    ----------
    outside : Suspension
        What moves the ball in flight.
    spring, damper : float or array
        ϖ² and 2ζϖ.

    Raises
    ------
    ParameterError
        If the oscillator that they form is not underdamped.
    """

    outside: Suspension
    spring: Any
    damper: Any

    def __post_init__(self) -> None:
        if np.any(self.loss * self.loss >= 4 * self.stiffness):
            raise ParameterError(
                "the contact with this {flight} is overdamped: its drag or damping must be smaller"
            )

    @property
    def loss(self) -> Any:
        """l + 2ζϖ."""
        return self.outside.loss + self.damper

    @property
    def stiffness(self) -> Any:
        """q + ϖ²."""
        return self.outside.stiffness + self.spring

    @property
    def load(self) -> Any:
        """b."""
        return self.outside.load

    @property
    def damped_frequency(self) -> np.ndarray:
        """√(Q - L²/4), the frequency of the free oscillations."""
        half = np.asarray(self.loss, dtype=float) / 2
        return np.sqrt(np.asarray(self.stiffness, dtype=float) - half * half)

    def coefficients(self, waveform: Waveform) -> np.ndarray:
        """The harmonics of W_c, over Λ, shape (N,) or (balls, N)."""
        k = waveform.orders
        driven = self.outside.off_resonance(k) / self.off_resonance(k)
        return driven * self.outside.coefficients(waveform)

    def check(self, waveform: Waveform) -> None:
        """Raise :class:`ParameterError` at an undamped resonance with a harmonic of the table."""
        k = waveform.orders
        near = np.abs(self.off_resonance(k)) < _RESONANCE * np.maximum(
            k * k, np.asarray(self.stiffness, dtype=float)[..., np.newaxis]
        )
        if np.any(near & (waveform.coefficients != 0)):
            raise ParameterError(
                "an undamped contact must not be in resonance with a harmonic of the {table}: its "
                "frequency is a whole number that the table has"
            )


def held_by(law: Any, setting: Any) -> Held:
    """The contacts of a linear law in a setting."""
    return Held(setting.suspension, law.stiffness, law.loss)


def response(coefficients: np.ndarray, orders: np.ndarray, lag: Any) -> np.ndarray:
    """The harmonics of S, over Λ: those of -(W_c + κ W_c′), with a last axis for the harmonics."""
    turn = 1 + 1j * orders * np.asarray(lag, dtype=float)[..., np.newaxis]
    return -turn * coefficients


class _Forced(Motion):
    """S less a level, which is the same for the whole search; it ends after one period."""

    def __init__(self, real: np.ndarray, imag: np.ndarray, level: np.ndarray) -> None:
        self.real = real
        self.imag = imag
        self.level = level

    def __call__(self, time: np.ndarray) -> Derivatives:
        k = np.arange(1, self.real.shape[-1] + 1)
        sine, cosine = sine_and_cosine(k * time[..., np.newaxis])
        real = self.real * cosine - self.imag * sine
        imag = self.imag * cosine + self.real * sine
        size = np.hypot(self.real, self.imag)
        return Derivatives(
            value=imag.sum(axis=-1) - self.level,
            rate=(k * real).sum(axis=-1),
            second=-(k**2 * imag).sum(axis=-1),
            third=-(k**3 * real).sum(axis=-1),
            second_bound=(k**2 * size).sum(axis=-1),
            third_bound=(k**3 * size).sum(axis=-1),
            fourth_bound=(k**4 * size).sum(axis=-1),
            ended=time > _TURN,
        )


class HeldMotion(Motion):
    """The motion y = δ + κ δ′ of balls in contact, whose first upward zero is the release.

    Parameters
    ----------
    flight : LinearFlight
        δ in contact.
    lag : float or array
        κ.
    most : float or array
        The largest S.
    """

    def __init__(self, flight: LinearFlight, lag: Any, most: Any) -> None:
        self.flight = flight
        self.lag = lag
        self.most = most
        self.rest = flight.load / flight.stiffness
        # The harmonics of S at the start, shape (balls, N).
        start = flight.real + 1j * flight.imag
        driven = response(start, flight.waveform.orders, lag)
        self.real = driven.real
        self.imag = driven.imag

    def earliest_release(self) -> np.ndarray:
        """The start: y is negative then, or falls."""
        return np.zeros(np.shape(self.flight.velocity))

    def release(self, end: Zero, height: np.ndarray) -> np.ndarray:
        """δ′ at a release, which is y′ there if κ = 0."""
        _, velocity, _, _ = self.flight.gap(end.time)
        return np.where(self.lag == 0, end.rate, velocity)

    def __call__(self, time: np.ndarray) -> Derivatives:
        at = self.flight.lagged(time, self.lag)
        above = self._free_level(at) + self.most
        slack = ROUNDING * np.abs(self.rest)
        return at.derivatives(ended=above <= slack)

    def _free_level(self, at: Any) -> np.ndarray:
        """b/Q + R, which with S is a bound of y."""
        speed = at.free_rate * at.free_rate / self.flight.stiffness
        return self.rest + np.sqrt((at.free - self.rest) ** 2 + speed)

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        """A time up to which y is negative, because its bound is: that at which S reaches
        -(b/Q + R).
        """
        if steps < PATIENCE:
            return time
        level = -self._free_level(self.flight.lagged(time, self.lag))
        k = self.flight.waveform.orders
        sine, cosine = sine_and_cosine(k * time[..., np.newaxis])
        real = self.real * cosine - self.imag * sine
        imag = self.imag * cosine + self.real * sine
        below = np.flatnonzero(imag.sum(axis=-1) < level)
        if not below.size:
            return time
        later = time.copy()
        search = _Forced(real[below], imag[below], level[below])
        found = first_zero(search, np.zeros(below.size))
        wait = np.where(found.ended, _TURN, found.time - _BEFORE)
        wait = np.where(found.undecided, 0.0, wait)
        later[below] += np.maximum(wait, 0.0)
        return later


@dataclass(frozen=True, repr=False)
class HeldContactDynamics(LinearContactDynamics):
    """The dynamics of an underdamped :class:`~bouncing_ball.models.spring_damper.SpringDamper` in
    another setting than that of the paper.

    Examples
    --------
    A second harmonic below rounding changes nothing:

    >>> import numpy as np
    >>> from bouncing_ball import Waveform, simulate, spring_damper
    >>> ball = dict(frequency_ratio=10.0, restitution=0.85)
    >>> one, two = (
    ...     simulate(spring_damper(**ball, **more), amplitude=1.1, impacts=3).time.values
    ...     for more in ({}, {"table": Waveform([1.0, 1e-300])})
    ... )
    >>> bool(np.abs(one - two).max() < 1e-13)
    True
    """

    @property
    def oscillator(self) -> Held:
        """What moves the balls in contact."""
        return held_by(self.law, self.setting)

    def depart(
        self, impact: Impact, *, near: np.ndarray | None = None, differentiate: bool = False
    ) -> Departure:
        """The end of each contact, permanent contact, or a flight that never ends.

        Ends near given durations are not examined for flights that never end.
        """
        departure = super().depart(impact, near=near, differentiate=differentiate)
        if near is not None or not departure.flight.may_miss:
            return departure
        going = np.flatnonzero(departure.status == Status.BOUNCING)
        start, resumed = self.take(going).resumption(departure.flight.take(going))
        return departure.with_landings(going[~resumed], start[~resumed])

    def _motion(self, impact: Impact) -> Any:
        flight = gap_in_contact(self.law, self.setting, impact, self.amplitude)
        lag = self.law.lag
        waveform = self.setting.waveform
        unit = largest(response(self.oscillator.coefficients(waveform), waveform.orders, lag))
        return HeldMotion(flight, lag, self.amplitude * unit)

    def within(
        self, impact: Impact, departure: Departure, time: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times since the starts of contacts, of shape (..., contacts), whether the
        contacts have ended or not.
        """
        flight = gap_in_contact(self.law, self.setting, impact, self.amplitude)
        displacement, velocity, _, _ = flight.gap(time)
        return displacement, velocity

    def _released(self, impact: Impact, departure: Departure) -> Released:
        """The deviations at the release of unit deviations of φ and of δ′ at the impact.

        As in :class:`.LinearContactDynamics`, the deviation of φ is one along the motion less one
        of the state where a contact forgets its start.
        """
        path = gap_in_contact(self.law, self.setting, impact, self.amplitude)
        duration = departure.duration
        held = self.oscillator
        decay = exponential(-np.asarray(held.loss) / 2 * duration)
        forgets = decay * np.sqrt(held.stiffness) < 1
        acceleration = path.gap(np.zeros(duration.shape))[2]
        none = np.zeros(duration.shape)
        by_phase = Deviation(
            phase=np.where(forgets, 0.0, 1.0),
            displacement=np.where(forgets, -impact.velocity, 0.0),
            velocity=np.where(forgets, -acceleration, 0.0),
        )
        # A contact that resumes starts at δ + κ δ′ = 0: its displacement deviates by -κ dδ′.
        lag = self.law.lag * (impact.displacement < 0)
        by_velocity = Deviation(none, none - lag, none + 1)
        speed = departure.flight.velocity
        return Released(
            *(
                path.carried(each, None, duration, speed, self.law.lag)
                for each in (by_phase, by_velocity)
            )
        )


def held_threshold(law: Any, setting: Any) -> np.ndarray:
    """The Λ up to which balls on linear contacts never leave the table: -b/(Q max S/Λ), and 0 for a
    spring that does not press the mass on its stop.

    Examples
    --------
    For a sine it is Λ_SD (Eq. 33):

    >>> from bouncing_ball.models.setting import GeneralSetting
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> from bouncing_ball.models.suspension import Drag
    >>> sine = GeneralSetting(Waveform([1.0]), Drag(0.0))
    >>> at = held_threshold(SpringDamper(2.0, 0.5), sine)
    >>> round(float(at) / 13**0.5, 12)
    0.25
    """
    held = held_by(law, setting)
    waveform = setting.waveform
    unit = largest(response(held.coefficients(waveform), waveform.orders, law.lag))
    return np.maximum(-held.load / np.asarray(held.stiffness), 0.0) / unit


def gap_in_contact(law: Any, setting: Any, start: Any, amplitude: Any) -> LinearFlight:
    """δ in the contacts of a linear law from their starts on, which have φ, δ and δ′."""
    held = held_by(law, setting)
    return LinearFlight(
        start.displacement, start.velocity, start.phase, amplitude, setting.waveform, held
    )
