"""What the impacts of a ball happen on: how the table moves, and what moves the ball in flight.

In the setting of the paper the table moves as Λ sin τ and the ball flies freely, and all functions
have their closed forms, with which a ball is simulated 2.5 to 4.6 times as fast as with those of
any setting, to which they are equal but for rounding. In any other setting the table is a
:class:`~bouncing_ball.models.waveform.Waveform` and the ball has a
:class:`~bouncing_ball.models.suspension.Suspension`.
"""

from dataclasses import dataclass, is_dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from bouncing_ball.errors import ParameterError, shortened
from bouncing_ball.models.flight import Flight, table
from bouncing_ball.models.linear_flight import LinearFlight, Pressure
from bouncing_ball.models.suspension import Drag, Suspension
from bouncing_ball.models.waveform import SINE, Waveform
from bouncing_ball.numerics.arrays import Batch
from bouncing_ball.numerics.elementary import arctangent, reduce_angle
from bouncing_ball.numerics.first_zero import first_zero

# A ball at a phase at which the acceleration δ″ at rest is below this part of its terms, and rises,
# is at its lift-off.
_ROUNDING = 1e-12
_TURN = 2 * np.pi


class LiftOff(NamedTuple):
    """The next lift-offs of balls that rest on the table.

    ``never`` marks the balls that stay for ever. The others leave after the time ``wait``, at the
    table's ``phase``.
    """

    never: np.ndarray
    wait: np.ndarray
    phase: np.ndarray


def lift_off_velocity(amplitude: np.ndarray) -> np.ndarray:
    """The velocity √(Λ² - 1) of the table of the paper at lift-off, for Λ ≥ 1."""
    return np.sqrt((amplitude - 1) * (amplitude + 1))


def lift_off_phase(amplitude: np.ndarray) -> np.ndarray:
    """The phase arcsin(1/Λ) at which Λ sin τ rises through 1 and balls at rest leave the table of
    the paper (Eq. 9), for Λ ≥ 1.

    Examples
    --------
    >>> bool(np.isclose(lift_off_phase(2.0), np.pi / 6))
    True
    """
    return arctangent(1.0, lift_off_velocity(amplitude))


class Setting(Batch):
    """The setting of the paper: a table Λ sin τ, and free flight."""

    @property
    def shape(self) -> tuple[int, ...]:
        """(), because nothing differs from ball to ball."""
        return ()

    def _entries(self, shape: tuple[int, ...], index: Any) -> Self:
        return self

    def __repr__(self) -> str:
        return "Setting()"

    @property
    def waveform(self) -> Waveform:
        """The shape u of the table."""
        return SINE

    @property
    def is_paper(self) -> bool:
        """Whether the table is a sine and the flight is free."""
        return True

    @property
    def is_free(self) -> bool:
        """Whether gravity alone acts in flight."""
        return True

    def level(self, phase: np.ndarray, amplitude: Any) -> tuple[np.ndarray, np.ndarray]:
        """The table's velocity w′ and height w."""
        return table(phase, amplitude)

    def at_rest(
        self, phase: np.ndarray, level: tuple[np.ndarray, np.ndarray], amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        """-g′ and 1 - g, with the load g = -δ″ that presses a ball at rest on the table.

        The first one contains also what changes the length of the chattering, see
        :func:`~bouncing_ball.models.restitution.chattering`. In the setting of the paper these
        numbers are those of ``level``.
        """
        return level

    def forcing(self, amplitude: np.ndarray) -> np.ndarray:
        """What a contact law needs of the load 1 + w″ of balls on the table: Λ in the setting of
        the paper, and otherwise the harmonics of -w″, complex, shape (N, balls).
        """
        return amplitude

    def strength(self, amplitude: Any) -> Any:
        """A number S with g ≤ 1 + S and ``|g′| ≤ S`` at all phases."""
        return amplitude

    def flight(
        self,
        displacement: np.ndarray,
        velocity: np.ndarray,
        phase: np.ndarray,
        level: tuple[np.ndarray, np.ndarray],
        amplitude: Any,
    ) -> Any:
        """The flight of balls that leave the table with δ and δ′ at a phase, with the table's state
        ``level`` there.
        """
        x, y = level
        return Flight(displacement, velocity, x, y, amplitude)

    def arriving(self, flight: Any, time: np.ndarray, phase: np.ndarray, amplitude: Any) -> Any:
        """δ″ at the end of a flight, at the table's phase."""
        return table(reduce_angle(phase), amplitude)[1] - 1

    def lift_off(self, phase: np.ndarray, amplitude: np.ndarray) -> LiftOff:
        """The next lift-offs of balls that rest on the table from a phase on: where Λ sin τ rises
        through 1.
        """
        lift = lift_off_phase(np.maximum(amplitude, 1.0))
        wait = np.mod(reduce_angle(lift - phase), _TURN)
        # Rounding must not postpone a lift-off at the present phase by a full turn.
        wait = np.where(wait > _TURN - 1e-9, 0.0, wait)
        return LiftOff(amplitude <= 1, wait, lift)

    def lifted_level(
        self, lift: LiftOff, amplitude: np.ndarray
    ) -> tuple[np.ndarray | float, np.ndarray | float]:
        """The table's state at lift-offs. At lift-off Λ sin τ = 1 exactly."""
        return lift_off_velocity(np.maximum(amplitude, 1.0)), 1.0

    def lifts_at(self, phase: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        """Whether balls at rest are at a lift-off."""
        lam = np.asarray(amplitude, dtype=float)
        lift = lift_off_phase(np.maximum(lam, 1.0))
        return phase == np.where(lam > 1, lift, np.nan)

    def contraction(self, time: np.ndarray) -> Any:
        """The factor by which flights of these durations multiply areas of the phase plane."""
        return 1.0

    def threshold(self) -> Any:
        """The Λ up to which a ball at rest stays on the table."""
        return 1.0


PAPER = Setting()
"""The setting of the paper."""


@dataclass(frozen=True, repr=False)
class OtherSetting(Setting):
    """A table of several harmonics, or a ball with drag or on a spring."""

    form: Any
    suspension: Suspension

    # Batch, not the setting of the paper, knows what is in the fields.
    shape = Batch.shape
    _entries = Batch._entries
    __repr__ = Batch.__repr__

    def __post_init__(self) -> None:
        if not isinstance(self.form, Waveform):
            # An engineer's table has a long text.
            shown = type(self.form).__name__ if is_dataclass(self.form) else shortened(self.form)
            raise ParameterError("{table} = {} is not a Waveform, the shape of its motion", shown)
        if not isinstance(self.suspension, Suspension):
            raise ParameterError(
                "{flight} = {} is neither Drag nor Spring", shortened(self.suspension)
            )
        self.suspension.check(self.form)

    @property
    def waveform(self) -> Waveform:
        return self.form

    @property
    def is_paper(self) -> bool:
        return False

    def level(self, phase: np.ndarray, amplitude: Any) -> tuple[np.ndarray, np.ndarray]:
        turned = self.form._turned(phase)
        velocity = (self.form.orders * turned.real).sum(axis=-1)
        return amplitude * velocity, amplitude * turned.imag.sum(axis=-1)

    def at_rest(
        self, phase: np.ndarray, level: tuple[np.ndarray, np.ndarray], amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        push = Pressure(phase, amplitude, self.form, self.suspension)(np.zeros(phase.shape))
        # A loss l shortens the chattering time T₀ by l T₀/6, as g′ does by g′T₀/(3g).
        return push.rate + self.suspension.loss * push.value / 2, 1 + push.value

    @property
    def is_free(self) -> bool:
        return not np.any(self.suspension.loss) and not np.any(self.suspension.stiffness)

    def forcing(self, amplitude: np.ndarray) -> np.ndarray:
        k = self.form.orders
        return (k * k * self.form.coefficients)[:, np.newaxis] * amplitude

    def strength(self, amplitude: Any) -> Any:
        waveform = self.form
        size = np.abs(self.suspension.coefficients(waveform)) * self._answer
        lam = np.asarray(amplitude, dtype=float)
        of_load = lam * size.sum(axis=-1) + np.abs(self.suspension.load)
        return np.maximum(of_load, lam * (waveform.orders * size).sum(axis=-1))

    @property
    def _answer(self) -> np.ndarray:
        """``|k² - q - ilk|``, the load of each harmonic of W over its size."""
        k = self.form.orders
        q = np.asarray(self.suspension.stiffness, dtype=float)[..., np.newaxis]
        loss = np.asarray(self.suspension.loss, dtype=float)[..., np.newaxis]
        return np.hypot(k * k - q, loss * k)

    def flight(
        self,
        displacement: np.ndarray,
        velocity: np.ndarray,
        phase: np.ndarray,
        level: tuple[np.ndarray, np.ndarray],
        amplitude: Any,
    ) -> Any:
        return LinearFlight(displacement, velocity, phase, amplitude, self.form, self.suspension)

    def arriving(self, flight: Any, time: np.ndarray, phase: np.ndarray, amplitude: Any) -> Any:
        return flight.gap(time)[2]

    def lift_off(self, phase: np.ndarray, amplitude: np.ndarray) -> LiftOff:
        push = Pressure(phase, amplitude, self.form, self.suspension)
        found = first_zero(push, np.zeros(phase.shape))
        never = found.ended | found.undecided
        wait = np.where(found.time > _TURN - 1e-9, 0.0, found.time)
        return LiftOff(never, wait, reduce_angle(phase + wait))

    def lifted_level(
        self, lift: LiftOff, amplitude: np.ndarray
    ) -> tuple[np.ndarray | float, np.ndarray | float]:
        return self.level(lift.phase, amplitude)

    def lifts_at(self, phase: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        push = Pressure(phase, amplitude, self.form, self.suspension)(np.zeros(phase.shape))
        slack = _ROUNDING * (np.abs(self.suspension.load) + push.second_bound)
        return (np.abs(push.value) <= slack) & (push.rate > 0)

    def contraction(self, time: np.ndarray) -> Any:
        return np.exp(-self.suspension.loss * time)

    def threshold(self) -> Any:
        # The load of the table has its least value near one of these phases; one step of Newton's
        # method for the extremum makes the error one of the fourth order of their distance.
        waveform = self.form
        phase = np.linspace(-np.pi, np.pi, 256 * waveform.orders[-1] + 1)
        found = []
        for k in range(self.size):
            on = self.suspension.flat(self.suspension.shape).take(k)
            free = Pressure(phase, 1.0, waveform, on)(np.zeros(phase.shape))
            top = int(np.argmax(free.value))
            best = free.value[top] - free.rate[top] ** 2 / (2 * free.second[top])
            load = float(np.asarray(on.load))
            found.append(max(-load, 0.0) / float(best - load))
        return np.reshape(found, self.shape)


def require_setting(setting: Any) -> None:
    """Raise :class:`ParameterError` unless the argument ``setting`` of a model is one."""
    if not isinstance(setting, Setting):
        raise ParameterError("setting = {} is not a Setting", shortened(setting))


def require_paper(setting: Setting, what: str) -> None:
    """Raise :class:`ParameterError` in another setting than that of the paper."""
    if not setting.is_paper:
        raise ParameterError(
            f"{what} are known for a table that moves as a sine, with free flight: use "
            "follow(orbit(…)) for another table or flight"
        )


def require_sine(setting: Setting, what: str) -> None:
    """Raise :class:`ParameterError` in another setting than that of the paper, for what has no form
    for it.
    """
    if not setting.is_paper:
        raise ParameterError(
            f"{what} is known for a table that moves as a sine, with free flight, and not for "
            "another {table} or {flight}"
        )


def setting_of(waveform: Waveform | None, suspension: Suspension | None) -> Setting:
    """The setting of a table and of what moves the ball; None stands for those of the paper."""
    if waveform is None and suspension is None:
        return PAPER
    form = SINE if waveform is None else waveform
    return OtherSetting(form, Drag(0.0) if suspension is None else suspension)
