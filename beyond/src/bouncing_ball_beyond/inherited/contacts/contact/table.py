"""The vibrating table: what a user gives of it, and the motion that follows."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property

from bouncing_ball_beyond.inherited.contacts.contact.quantities import (
    Acceleration,
    Frequency,
    Gravity,
    TableAmplitude,
    convert,
    given,
    single,
)
from bouncing_ball_beyond.inherited.contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError, require, suggesting

# Beyond this limit the square of Λ leaves no digits. The other calls have the same limit.
_LARGEST = 1e8


@dataclass(frozen=True)
class TableMotion:
    """The motion A sin Ωt of a table, and gravity: the units of time and length of the models.

    Parameters
    ----------
    angular_frequency, table_amplitude : float
        Ω in rad/s and the amplitude A of the table in m.
    gravity : float
        g in m/s²; for a gear pair, the deceleration that the drag torque causes.

    Examples
    --------
    >>> TableMotion(angular_frequency=2.0, table_amplitude=2.0, gravity=8.0).amplitude
    1.0
    """

    angular_frequency: float
    table_amplitude: float
    gravity: float

    @classmethod
    def at_rest(cls, gravity: float | None = None) -> "TableMotion":
        """A table at rest. The unit of time is 1 s, so that ϖ is ω of the contact in rad/s."""
        return cls(1.0, 0.0, gravity or STANDARD_GRAVITY)

    @property
    def is_at_rest(self) -> bool:
        """Whether the table does not move."""
        return self.table_amplitude == 0

    @cached_property
    def amplitude(self) -> float:
        """Excitation amplitude Λ = AΩ²/g, the greatest acceleration of the table over gravity."""
        return self.table_amplitude * self.angular_frequency**2 / self.gravity

    @cached_property
    def time(self) -> float:
        """Unit of time, 1/Ω, in s."""
        return 1 / self.angular_frequency

    @cached_property
    def length(self) -> float:
        """Unit of length, g/Ω², in m."""
        return self.gravity / self.angular_frequency**2


@suggesting
@dataclass(frozen=True, kw_only=True)
class Table:
    """A vibrating table: one parameter for its frequency, one for its amplitude, and gravity.

    Parameters
    ----------
    frequency
        Frequency of the table in Hz, or with its unit in rad/s or rpm.
    table_amplitude
        Amplitude A of the table's motion, in m; or give the acceleration.
    acceleration
        Greatest acceleration AΩ² of the table, in m/s²; "2 g" is twice standard gravity.
    gravity
        Acceleration of gravity, by default 9.80665 m/s². For a gear pair, the deceleration that the
        drag torque causes.

    Raises
    ------
    ModelError
        If a quantity is out of range or of another dimension, or if parameters are missing or
        contradict each other.

    Examples
    --------
    >>> table = Table(frequency="50 Hz", acceleration="0.8 g")
    >>> table.frequency, round(table.acceleration, 5), round(table.motion.amplitude, 12)
    (50.0, 7.84532, 0.8)
    """

    frequency: Frequency = None
    table_amplitude: TableAmplitude = None
    acceleration: Acceleration = None
    gravity: Gravity = None
    hint: str = field(default="", init=False, repr=False, compare=False)
    """What may have been meant if no model has an orbit: an acceleration in g without its unit."""

    def __post_init__(self) -> None:
        written = self.acceleration
        convert(self)
        # Gravity is given for tables on which g is no unit.
        in_g = written is None or str(written).strip().endswith("g")
        hidden = in_g or self.gravity is not None
        meant = "" if hidden else f"perhaps {self.acceleration:g} g was meant"
        object.__setattr__(self, "hint", meant)
        amplitude = self.motion.amplitude
        require(amplitude < _LARGEST, amplitude, "Λ", f"below {_LARGEST:g}")

    @cached_property
    def motion(self) -> TableMotion:
        """Ω, A and g."""
        data = given(self)
        if self.frequency is None:
            raise ParameterError(
                "the frequency of the table is missing: give {frequency}, such as 50 Hz"
            )
        ways = "{acceleration}, such as 2 g, or {table_amplitude}, such as 0.1 mm"
        far = single(data, ("table_amplitude", "acceleration"), "the amplitude of the table", ways)
        omega = 2 * math.pi * self.frequency
        moved = self.table_amplitude
        if far == "acceleration":
            moved = self.acceleration / omega**2
        return TableMotion(omega, moved, data.get("gravity", STANDARD_GRAVITY))

    @contextmanager
    def hinting(self) -> Iterator[None]:
        """A context in which the error of a missing orbit also says what may have been meant."""
        try:
            yield
        except NoOrbitError as error:
            raise NoOrbitError("; ".join(filter(None, [str(error), self.hint]))) from None
