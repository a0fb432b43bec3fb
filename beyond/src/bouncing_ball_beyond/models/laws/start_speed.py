r"""Contact laws whose damping is set by the speed at the start of each contact.

The force of both laws is Hertz' with a hysteresis damping, ``f = K p^{3/2} (1 + c p′/v₀)``, where
v₀ is the speed at which the contact starts and c a number that follows from a nominal restitution
coefficient e::

    Lankarani and Nikravesh:   c = 3(1 - e²)/4
    Flores and others:         c = 8(1 - e)/(5e)

In one contact this is the law of Hunt and Crossley with C = c/v₀. The group C v₀ = c of a free
impact is the same at every speed, so that its restitution coefficient r is the same at every speed,
too. With y = C p′ the energy of a free impact gives ``y - ln(1 + y)`` the same value at c and at
-r c, or ::

    c (1 + r) = ln((1 + c)/(1 - r c))

r is not e: for e = 0.5 it is 0.725 with the first law and 0.470 with the second. As e tends to 1,
the loss 1 - r tends to 2c/3, which is 1 - e with the first law and 16(1 - e)/15 with the second.

Where such a law is not smooth: v₀ jumps from contact to contact, and as it tends to zero the
damping grows without limit. A ball that is laid on the table, with v₀ = 0, would never sink; starts
slower than 10⁻⁹ are damped as one with this speed. A ball that is held by its weight after a slow
start creeps in and out, and where it is pulled out faster than v₀/c the force is negative: the law
lets the contact pull. Its release is at p = 0, at which the force vanishes. Chattering therefore is
that of very strong damping, and no theorem for fixed C applies to it. The derivatives of the return
map contain that of C by v₀, and a contact multiplies areas by a factor that is not exp(-∫∂f/∂p′).
The threshold of permanent contact, and whether a contact without an end is permanent, are those of
the elastic part.

Sources: the forces as in the functions ``Contact_LN`` and ``Contact_FM`` of public Matlab code for
multibody contacts, and in a table of a public verification of contact models, which give both with
these factors; the first names H. M. Lankarani and P. E. Nikravesh, *A contact force model with
hysteresis damping for impact analysis of multibody systems*, Journal of Mechanical Design 112
(1990) 369-376. The papers themselves were not read.
"""

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, require
from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.force_law import NUMBER, ForceLaw, Scaled, Unit
from bouncing_ball_beyond.models.laws.hertzian import Hertz, HuntCrossley

# Starts that are slower are damped as one with this speed.
_SLOWEST = 1e-9
_ROUNDING = np.finfo(float).eps


@dataclass(frozen=True, repr=False)
class StartedContact(HuntCrossley):
    """The law of Hunt and Crossley in contacts that start with the speeds v₀, with C = c/v₀.

    Parameters
    ----------
    stiffness, damping, speed : float or array
        K, C and v₀.
    """

    speed: float | np.ndarray

    feels_start_speed: ClassVar[bool] = True

    def by_start(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """∂f/∂v₀ = -K p^{3/2} C p′/v₀."""
        elastic = self.stiffness * penetration * np.sqrt(penetration)
        return -elastic * self.damping * rate / self.speed


@dataclass(frozen=True, repr=False)
class DampedByStart(ContactLaw):
    """``f = K p^{3/2} (1 + c p′/v₀)`` with a number c.

    Parameters
    ----------
    stiffness : float or array
        K > 0.
    nominal_restitution : float or array
        e in (0, 1], which gives c.

    Raises
    ------
    ModelError
        If K or e is outside its range.
    """

    stiffness: float | np.ndarray
    nominal_restitution: float | np.ndarray

    feels_start_speed: ClassVar[bool] = True
    units: ClassVar[dict[str, Unit]] = {
        "stiffness": Hertz.units["stiffness"],
        "nominal_restitution": NUMBER,
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        check_positive(self.stiffness, "stiffness K")
        e = np.asarray(self.nominal_restitution, dtype=float)
        require((e > 0) & (e <= 1), e, "nominal restitution e", "in (0, 1]")

    @property
    @abstractmethod
    def factor(self) -> Any:
        """c."""

    @classmethod
    @abstractmethod
    def nominal_of(cls, factor: np.ndarray) -> np.ndarray:
        """The e that gives c, the inverse of :attr:`factor`; NaN where there is none."""

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """c that gives a restitution coefficient r in (0, 1]: y - ln(1 + y) is the same at c and at
        -r c.

        Raises
        ------
        ModelError
            If no nominal restitution gives it: r is at least 0.66296 with the first law.

        Examples
        --------
        >>> round(Flores.group_of(0.47), 3), Flores.group_of(1.0)
        (1.603, 0.0)
        """
        r = restitution

        def loss(c: float) -> float:
            """Positive below the root, divided by the double root at 0."""
            return (c * (1 + r) + math.log1p(-r * c) - math.log1p(c)) / (c * c)

        # The root is about 3(1 - r²)/(2(1 + r³)). At c = 1/r the ball no longer leaves.
        most = (1 - _ROUNDING) / r
        c = 0.0
        if r < 1:
            c = math.inf
            if loss(most) < 0:
                c = float(scipy.optimize.brentq(loss, 0.5 * (1 - r * r), most, xtol=1e-16))
        if not math.isfinite(c) or np.isnan(cls.nominal_of(np.asarray(c))):
            raise ModelError(
                f"restitution coefficient r = {r:g} is too small: no {cls.name} contact has it; "
                "damped so strongly, the ball hardly leaves"
            )
        return c

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """The elastic part of the force, K p^{3/2}: that of a ball at rest on its contact. The
        whole force is that of :meth:`started`.
        """
        return self.stiffness * penetration * np.sqrt(penetration) + 0 * rate

    def started(self, speed: ArrayLike) -> ForceLaw:
        """The laws of contacts that start with the speeds v₀.

        Examples
        --------
        >>> LankaraniNikravesh(100.0, 0.5).started(2.0)
        StartedContact(stiffness=100, damping=0.28125, speed=2)
        """
        # A contact without a speed, which is NaN, gives NaN whatever its law is.
        v = np.fmax(np.asarray(speed, dtype=float), _SLOWEST)
        return StartedContact(self.stiffness, self.factor / v, v)

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with K = v²/P^{5/2} and c = ``group``."""
        v = np.asarray(speed, dtype=float)
        stiffness = v * v / np.asarray(length, dtype=float) ** 2.5
        e = cls.nominal_of(np.asarray(group, dtype=float))
        if np.any(np.isnan(e)):
            raise ModelError(f"no nominal restitution of {cls.name} has so much damping")
        return cls(stiffness, e + 0 * stiffness)

    def scaled(self, speed: np.ndarray) -> Scaled:
        """With P = (v²/K)^{2/5}; c is the same at every speed."""
        length = (speed * speed / self.stiffness) ** 0.4
        return Scaled(
            group=self.factor + 0 * length,
            time=length / speed,
            group_exponent=0.0,
            time_exponent=-0.2,
        )


@dataclass(frozen=True, repr=False)
class LankaraniNikravesh(DampedByStart):
    """The law of Lankarani and Nikravesh, c = 3(1 - e²)/4.

    Parameters
    ----------
    stiffness, nominal_restitution : float or array
        K > 0 and e in (0, 1].

    Examples
    --------
    >>> import bouncing_ball_beyond
    >>> ball = bouncing_ball_beyond.contact_law(LankaraniNikravesh(1000.0, 0.9))
    >>> [round(float(ball.signature(v).restitution), 6) for v in (0.5, 5.0)]
    [0.913177, 0.913177]
    """

    name: ClassVar[str] = "lankarani-nikravesh"

    @property
    def factor(self) -> Any:
        """3(1 - e²)/4."""
        e = self.nominal_restitution
        return 0.75 * (1 - e * e)

    @classmethod
    def nominal_of(cls, factor: np.ndarray) -> np.ndarray:
        """√(1 - 4c/3)."""
        with np.errstate(invalid="ignore"):
            e = np.sqrt(1 - factor / 0.75)
        return np.where(e > 0, e, np.nan)


@dataclass(frozen=True, repr=False)
class Flores(DampedByStart):
    """The law of Flores and others, c = 8(1 - e)/(5e).

    Parameters
    ----------
    stiffness, nominal_restitution : float or array
        K > 0 and e in (0, 1].

    Examples
    --------
    >>> Flores(1000.0, 0.5).factor
    1.6
    """

    name: ClassVar[str] = "flores"

    @property
    def factor(self) -> Any:
        """8(1 - e)/(5e)."""
        e = self.nominal_restitution
        return 1.6 * (1 - e) / e

    @classmethod
    def nominal_of(cls, factor: np.ndarray) -> np.ndarray:
        """1/(1 + 5c/8)."""
        return 1 / (1 + factor / 1.6)
