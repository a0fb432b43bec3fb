"""The setting of the impacts: how the table moves, and what moves the ball in flight.

In the setting of the paper the table moves as Λ sin τ and the ball flies freely, and all functions
have their closed forms (:class:`PaperSetting`), with which a ball is simulated 2.5 to 4.6 times as
fast as with those of any setting (:class:`GeneralSetting`), to which they are equal but for
rounding. In general the table is a :class:`~bouncing_ball.models.waveform.Waveform` and the ball
has a :class:`~bouncing_ball.models.suspension.Suspension`. Whether these are the paper's is decided
by their values, and a model then uses the closed forms.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, is_dataclass
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from bouncing_ball.errors import ParameterError, shortened
from bouncing_ball.models.flight import Flight, table
from bouncing_ball.models.linear_flight import LinearFlight, Pressure
from bouncing_ball.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.models.suspension import Drag, Suspension
from bouncing_ball.models.waveform import SINE, Waveform, largest, turned
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


class Setting(Batch, ABC):
    """How the table moves, and what moves the ball in flight."""

    @property
    @abstractmethod
    def waveform(self) -> Waveform:
        """The shape u of the table."""

    @property
    @abstractmethod
    def is_paper(self) -> bool:
        """Whether the table moves as sin τ and the flight is free."""

    @property
    @abstractmethod
    def is_free(self) -> bool:
        """Whether gravity alone acts in flight."""

    @abstractmethod
    def level(self, phase: np.ndarray, amplitude: Any) -> tuple[np.ndarray, np.ndarray]:
        """The table's velocity w′ and height w."""

    @abstractmethod
    def at_rest(
        self, phase: np.ndarray, level: tuple[np.ndarray, np.ndarray], amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        """-g′ and 1 - g, with the load g = -δ″ that presses a ball at rest on the table.

        The first one contains also what changes the length of the chattering, see
        :func:`~bouncing_ball.models.restitution.chattering`. In the setting of the paper these
        numbers are those of ``level``.
        """

    @abstractmethod
    def forcing(self, amplitude: np.ndarray) -> np.ndarray:
        """The load 1 + w″ of balls on the table, for contact laws: Λ in the setting of the paper,
        and otherwise the harmonics of -w″, complex, shape (N, balls).
        """

    @abstractmethod
    def strength(self, amplitude: Any) -> Any:
        """A number S with g ≤ 1 + S and ``|g′| ≤ S`` at all phases."""

    @abstractmethod
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

    @abstractmethod
    def lift_off(self, phase: np.ndarray, amplitude: np.ndarray) -> LiftOff:
        """The next lift-offs of balls that rest on the table from a phase on."""

    @abstractmethod
    def lifted_level(
        self, lift: LiftOff, amplitude: np.ndarray
    ) -> tuple[np.ndarray | float, np.ndarray | float]:
        """The table's state at lift-offs."""

    @abstractmethod
    def lifts_at(self, phase: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        """Whether balls at rest are at a lift-off."""

    @abstractmethod
    def contraction(self, time: np.ndarray) -> Any:
        """The factor by which flights of these durations multiply areas of the phase plane."""

    @abstractmethod
    def threshold(self) -> Any:
        """The Λ up to which a ball at rest stays on the table."""


class PaperSetting(Setting):
    """The setting of the paper: a table Λ sin τ, and free flight, in closed form."""

    @property
    def shape(self) -> tuple[int, ...]:
        """(), because nothing differs from ball to ball."""
        return ()

    def _entries(self, shape: tuple[int, ...], index: Any) -> Self:
        return self

    @property
    def waveform(self) -> Waveform:
        return SINE

    @property
    def is_paper(self) -> bool:
        return True

    @property
    def is_free(self) -> bool:
        return True

    def level(self, phase: np.ndarray, amplitude: Any) -> tuple[np.ndarray, np.ndarray]:
        return table(phase, amplitude)

    def at_rest(
        self, phase: np.ndarray, level: tuple[np.ndarray, np.ndarray], amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        return level

    def forcing(self, amplitude: np.ndarray) -> np.ndarray:
        return amplitude

    def strength(self, amplitude: Any) -> Any:
        return amplitude

    def flight(
        self,
        displacement: np.ndarray,
        velocity: np.ndarray,
        phase: np.ndarray,
        level: tuple[np.ndarray, np.ndarray],
        amplitude: Any,
    ) -> Any:
        x, y = level
        return Flight(displacement, velocity, x, y, amplitude)

    def lift_off(self, phase: np.ndarray, amplitude: np.ndarray) -> LiftOff:
        # Λ sin τ rises through 1.
        lift = lift_off_phase(np.maximum(amplitude, 1.0))
        wait = np.mod(reduce_angle(lift - phase), _TURN)
        # Rounding must not postpone a lift-off at the present phase by a full turn.
        wait = np.where(wait > _TURN - 1e-9, 0.0, wait)
        return LiftOff(amplitude <= 1, wait, lift)

    def lifted_level(
        self, lift: LiftOff, amplitude: np.ndarray
    ) -> tuple[np.ndarray | float, np.ndarray | float]:
        # At lift-off Λ sin τ = 1 exactly.
        return lift_off_velocity(np.maximum(amplitude, 1.0)), 1.0

    def lifts_at(self, phase: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        lam = np.asarray(amplitude, dtype=float)
        lift = lift_off_phase(np.maximum(lam, 1.0))
        return phase == np.where(lam > 1, lift, np.nan)

    def contraction(self, time: np.ndarray) -> Any:
        return 1.0

    def threshold(self) -> Any:
        return RESTITUTION_THRESHOLD


PAPER = PaperSetting()
"""The setting of the paper."""


@dataclass(frozen=True, repr=False)
class GeneralSetting(Setting):
    """A table of any number of harmonics, and a ball that falls freely, with drag or on a spring.

    Parameters
    ----------
    form : Waveform
        The shape u of the table.
    suspension : Suspension
        What moves the ball in flight.

    Raises
    ------
    ParameterError
        If they are of other types, or the spring is in resonance with the table.
    """

    form: Any
    suspension: Suspension

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

    @cached_property
    def is_paper(self) -> bool:
        # An array of drags makes a row of balls, also if all of them are 0.
        return not self.shape and self.form.is_sine and self.is_free

    def level(self, phase: np.ndarray, amplitude: Any) -> tuple[np.ndarray, np.ndarray]:
        form = self.form
        whole = turned(form.coefficients, form.orders, phase)
        velocity = (form.orders * whole.real).sum(axis=-1)
        return amplitude * velocity, amplitude * whole.imag.sum(axis=-1)

    def at_rest(
        self, phase: np.ndarray, level: tuple[np.ndarray, np.ndarray], amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        push = Pressure(phase, amplitude, self.form, self.suspension)(np.zeros(phase.shape))
        # A loss l shortens the chattering time T₀ by l T₀/6, as g′ does by g′T₀/(3g).
        return push.rate + self.suspension.loss * push.value / 2, 1 + push.value

    @property
    def is_free(self) -> bool:
        return self.suspension.is_free

    def forcing(self, amplitude: np.ndarray) -> np.ndarray:
        k = self.form.orders
        return (k * k * self.form.coefficients)[:, np.newaxis] * amplitude

    def strength(self, amplitude: Any) -> Any:
        waveform = self.form
        # The load of each harmonic of W over its size.
        answer = np.abs(self.suspension.off_resonance(waveform.orders))
        size = np.abs(self.suspension.coefficients(waveform)) * answer
        lam = np.asarray(amplitude, dtype=float)
        of_load = lam * size.sum(axis=-1) + np.abs(self.suspension.load)
        return np.maximum(of_load, lam * (waveform.orders * size).sum(axis=-1))

    def flight(
        self,
        displacement: np.ndarray,
        velocity: np.ndarray,
        phase: np.ndarray,
        level: tuple[np.ndarray, np.ndarray],
        amplitude: Any,
    ) -> Any:
        return LinearFlight(displacement, velocity, phase, amplitude, self.form, self.suspension)

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
        # Of a ball at rest δ″ = b + Λ Im Σ s_k e^{ikφ}, which reaches 0 first at this Λ.
        by_table = -self.suspension.off_resonance(self.form.orders)
        most = largest(by_table * self.suspension.coefficients(self.form))
        return np.maximum(-np.asarray(self.suspension.load), 0.0) / most


def require_setting(setting: Any) -> None:
    """Raise :class:`ParameterError` unless the argument ``setting`` of a model is one."""
    if not isinstance(setting, Setting):
        raise ParameterError("setting = {} is not a Setting", shortened(setting))


def require_paper(setting: Setting, what: str, instead: str = "") -> None:
    """Raise :class:`ParameterError` in another setting than that of the paper.

    ``what`` needs this setting, and ``instead`` is what a user can do in another one.
    """
    if not setting.is_paper:
        remedy = f": {instead}" if instead else ""
        raise ParameterError(
            f"a table that moves as a sine and free flight are needed for {what}, and this ball "
            f"has another {{table}} or {{flight}}{remedy}"
        )


def setting_of(waveform: Waveform | None, suspension: Suspension | None) -> Setting:
    """The setting of a table and of what moves the ball; None stands for those of the paper.

    Examples
    --------
    A table is that of the paper by its motion and not by its name:

    >>> setting_of(Waveform([1.0]), None)
    PaperSetting()
    >>> setting_of(Waveform([1.0]), Drag(0.0)).is_paper
    True
    """
    if suspension is None:
        if waveform is None or (isinstance(waveform, Waveform) and waveform.is_sine):
            return PAPER
        suspension = Drag(0.0)
    # A drag of 0 stays a parameter, which can vary.
    return GeneralSetting(SINE if waveform is None else waveform, suspension)
