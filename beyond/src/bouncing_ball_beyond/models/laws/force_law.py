"""The law of the contact force, the rule that ends the contact, and the root m.

The numerical methods of contacts need nothing else of a law, unless its force depends on the load
(:mod:`~bouncing_ball_beyond.models.laws.loaded`). How balls move on it follows from them, in
:class:`~bouncing_ball_beyond.models.laws.contact_law.ContactLaw`.

The penetration p = -δ of the ball into the table obeys ::

    p″ = a - f(p, p′),    a = 1 - Λ sin(τ + φ),    p(0) = 0,  p′(0) = v > 0

All quantities are dimensionless (times Ωt, lengths Ω²y/g); f is the force over
the weight of the ball. A law need not be smooth where p = 0, but between its kinks it is an
analytic function of ``p^{1/m}`` and p′: m = 1 for a linear force, m = 2 for terms such as
p^{3/2} or p^{1/2}, and m = 4 for p^{1/4}. The number m is part of a law, because the
numerical methods need it to keep their order at the ends of the contact.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.numerics.arrays import Batch, as_numbers
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.instant import Instant


class Unit(NamedTuple):
    """The name of a parameter's SI unit, and its powers of mass, length and time."""

    name: str
    mass: float = 0.0
    length: float = 0.0
    time: float = 0.0


NUMBER = Unit("")
"""The unit of a pure number."""


class Scaled(NamedTuple):
    """Impacts of laws in units of their scales P and P/v.

    ``group`` is the dissipation, on which alone such an impact depends, and ``time`` is P/v. Both
    are proportional to powers of the impact speed, whose exponents are the other fields.
    """

    group: np.ndarray
    time: np.ndarray
    group_exponent: float
    time_exponent: float


@dataclass(frozen=True, repr=False)
class ForceLaw(Batch, ABC):
    """The law of a contact force: a frozen dataclass of its dimensionless parameters.

    A subclass defines ``name`` and :meth:`force`; the other members have defaults.
    ``root`` is m, and ``release`` the rule that ends the contact. A subclass checks its parameters
    in ``__post_init__``, after that of this class, and raises
    :class:`~bouncing_ball_beyond.inherited.errors.ModelError`.
    """

    name: ClassVar[str]
    units: ClassVar[dict[str, Unit]] = {}
    """The units of all parameters, :data:`NUMBER` for a pure number. A law that has a name on the
    command line, or whose parameters are given in SI units, must declare them.
    """
    formula: ClassVar[str] = ""
    """The force as text, of mass m, stiffness k, damping C, depth x and its rate ẋ, if other
    programs give these constants another meaning.
    """
    root: ClassVar[int] = 2
    release = Release.DISPLACEMENT

    def __post_init__(self):
        if not hasattr(self, "name"):
            raise ModelError(f"the law {type(self).__name__} defines no name")
        # Laws are keys of caches, so that a parameter must be a number or an array with an axis.
        for name, value in self.parameters().items():
            # None stands for a default that the subclass sets.
            if value is None:
                continue
            as_numbers(value, name.replace("_", " "), "a number or an array of numbers")
            x = np.asarray(value)
            object.__setattr__(self, name, x if x.ndim else x.item())
        self.check_shape()

    @abstractmethod
    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f(p, p′) for p > 0: the force over the weight, positive when it pushes the ball away.

        The result has the shape to which p and p′ broadcast with the parameters. Complex arguments
        must be allowed, because derivatives are taken by imaginary steps.
        """

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """The force as a function of q = p^{1/m} and p′."""
        return self.force(root**self.root, rate)

    @property
    def lag(self) -> Any:
        """κ of a contact that ends where p + κ p′ = 0; None if its end has no such form, so that
        the grip must be evaluated.
        """
        return 0.0 if self.release.at_surface else None

    feels_start_speed: ClassVar[bool] = False
    """Whether the force depends on the speed at the start of the contact, see :meth:`started`."""

    def started(self, speed: ArrayLike) -> "ForceLaw":
        """The laws of contacts that start with these speeds p′; the law itself by default."""
        return self

    def by_start(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """The derivative of the force by the speed at the start of the contact."""
        return np.zeros_like(penetration)

    @property
    def has_kink(self) -> bool:
        """Whether the force has kinks, where :meth:`kink` changes its sign."""
        return False

    @property
    def is_smooth_by_speed(self) -> bool:
        """Whether r, D and the other numbers of a free impact are smooth functions of its speed. By
        default they are not if the force has kinks at given depths.
        """
        return not self.has_kink or self.lag is not None

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """A function of p and p′ that changes its sign where the continuous force has a kink, of
        the shape to which the arguments broadcast.
        """
        return np.ones_like(penetration)

    def grip(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Grip function: positive in contact, zero at release; of the shape to which p and p′
        broadcast with the parameters.
        """
        lag = self.lag
        return self.force(penetration, rate) if lag is None else penetration + lag * rate

    @property
    def constant_signature(self) -> Instant | None:
        """The signature of free impacts if it has a closed form and is the same at every speed,
        otherwise None.
        """
        return None

    @property
    def permanent_contact(self) -> Any:
        """The greatest Λ of permanent contact if it has a closed form, otherwise None."""
        return None

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with the length scale P at the speed v, and the dissipation ``group``.

        With P as the unit of length and P/v as that of time, its impact at the speed v is an
        impact of stiffness 1, damping ``group`` and speed 1.

        Raises
        ------
        ModelError
            If the law does not define this.
        """
        raise ModelError(f"{cls.name} is given by its parameters, not by restitution and duration")

    def scaled(self, speed: np.ndarray) -> Scaled | None:
        """The impacts at speeds v > 0 in units of their scales, the inverse of :meth:`of_scales`;
        None if the law does not define it.
        """
        return None

    @classmethod
    def group_of(cls, restitution: float) -> float | None:
        """The dissipation ``group`` that gives a restitution coefficient r if it has a closed
        form, otherwise None.
        """
        return None

    def stiffened(self, factor: float) -> Self:
        """The law whose stiffness k is greater by a factor; its other parameters are the same.

        Raises
        ------
        ModelError
            If the law has no parameter ``stiffness``, and does not define this.
        """
        if "stiffness" not in self.parameters():
            raise ModelError(f"{self.name} has no parameter stiffness")
        return replace(self, **{"stiffness": self.parameters()["stiffness"] * factor})

    @classmethod
    def parameter_names(cls) -> list[str]:
        """Names of the law's numerical parameters: all fields except ``release``."""
        return [field.name for field in fields(cls) if field.name != "release"]

    def parameters(self) -> dict[str, Any]:
        """Names and values of the law's numerical parameters, as they were given."""
        return {name: getattr(self, name) for name in self.parameter_names()}

    @classmethod
    def require_units(cls) -> None:
        """Raise :class:`~bouncing_ball_beyond.inherited.errors.ModelError` if a parameter has no
        declared unit.
        """
        for name in cls.parameter_names():
            if name not in cls.units:
                raise ModelError(f"{cls.name} declares no unit of its parameter {name}")

    def in_si(self, mass: float, length: float, time: float) -> dict[str, float]:
        """The parameters of a single law in SI units.

        The arguments are the units of mass, length and time of the dimensionless model, in SI.

        Raises
        ------
        ModelError
            If the law does not declare the unit of a parameter.
        """
        self.require_units()
        found = {}
        for name, value in self.parameters().items():
            unit = self.units[name]
            found[name] = value * mass**unit.mass * length**unit.length * time**unit.time
        return found

    @property
    def label(self) -> str:
        """The name and the parameters of a single law as text."""
        numbers = (f"{name.replace('_', ' ')} {x:.6g}" for name, x in self.parameters().items())
        return f"{self.name} with {', '.join(numbers)}"
