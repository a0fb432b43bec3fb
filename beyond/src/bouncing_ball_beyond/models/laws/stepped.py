r"""Contacts of multibody programs, whose force is stepped smoothly from 0 at the surface.

With a cubic step over a depth d, ::

    s(p) = x²(3 - 2x),  x = p/d,  for p < d,   and 1 beyond

the damper, or the whole force, grows from 0, so that the force does not jump where the contact
begins. No force pulls.

**IMPACT**, the function of Adams and of programs that have taken it over:
``f = max(0, K p^ν + C s(p) p′)``. Only the damper is stepped, and the force vanishes with p. The
contact ends at p = 0. A damper that would pull is left out meanwhile: where d is small against
C v/K, the force is 0 on the last part of the way out but for its very end, where the spring is
stronger than the stepped damper.

**Simscape Multibody**, *Spatial Contact Force*: ``f = s(p) (K p + C p′)``. Spring and damper are
stepped. The force vanishes where p + κ p′ = 0, κ = C/K, and the contact ends there. Its manual
gives no formula of the step, which is 0 and 1 with slopes of 0 at both ends: the cubic is the
polynomial of the lowest degree that is. Nor does it say whether the force may pull.

As d tends to 0, both are a spring and a damper that is released where the force vanishes. Otherwise
r depends on the speed: impacts much less deep than d lose little, and 1 - r is proportional to
v^{7/5} with IMPACT and ν = 3/2, to v² with ν = 1, and to √v with Simscape's contact. The curvature
of the step jumps at d, so that r(v) has only a few derivatives at the speed whose impact just
reaches d.

The physical forces ``k x^ν + c s x′`` and ``s (k x + c x′)`` have ``K = k g^{ν-1}/(m Ω^{2ν})`` and
``C = c/(mΩ)``. In a law that is given by an impact, d is a tenth of the scale of the penetration.

Sources: the manuals of SolidWorks Motion and Altair MotionSolve (IMPACT), and of Simscape
Multibody.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.models.damping import Release, check_damping
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.force_law import Unit
from bouncing_ball_beyond.models.laws.hertzian import Hertz, LinearHuntCrossley

# The depth d of a law that is given by an impact, over the scale of the penetration.
_SHARE = 0.1


@dataclass(frozen=True, repr=False)
class Stepped(ContactLaw):
    """A spring and a damper, of which the damper or the force is stepped over a depth.

    Parameters
    ----------
    stiffness, damping, depth : float or array
        K > 0, C ≥ 0 and d > 0.

    Raises
    ------
    ModelError
        If a parameter is outside its range.
    """

    stiffness: float | np.ndarray
    damping: float | np.ndarray
    depth: float | np.ndarray

    power: ClassVar[float] = 1.0
    has_kink: ClassVar[Any] = True
    is_smooth_by_speed: ClassVar[Any] = False
    units: ClassVar[dict[str, Unit]] = {
        "stiffness": LinearHuntCrossley.units["stiffness"],
        "damping": Unit("N s/m", 1, 0, -1),
        "depth": Unit("m", 0, 1, 0),
    }

    def __post_init__(self):
        super().__post_init__()
        check_positive(self.stiffness, "stiffness K")
        check_damping(self.damping, "damping C")
        check_positive(self.depth, "depth d")

    def step(self, penetration: np.ndarray) -> np.ndarray:
        """s(p)."""
        x = penetration / self.depth
        return np.where(np.real(x) < 1, x * x * (3 - 2 * x), 1.0)

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with K = v²/P^{1+ν}, C = ``group`` v/P and d = P/10."""
        scale = np.asarray(length, dtype=float)
        v = np.asarray(speed, dtype=float)
        return cls(v * v / scale ** (1 + cls.power), group * v / scale, _SHARE * scale + 0 * v)


@dataclass(frozen=True, repr=False)
class AdamsImpact(Stepped):
    """The function IMPACT with the exponent ν = 3/2.

    Parameters
    ----------
    stiffness, damping, depth : float or array
        K > 0, C ≥ 0 and d > 0, the depth of full damping.

    Examples
    --------
    >>> law = AdamsImpact(2.0, 3.0, 8.0)
    >>> [float(law.force(4.0, rate)) for rate in (2.0, -20.0)]
    [19.0, 0.0]
    """

    name: ClassVar[str] = "adams-impact"
    power: ClassVar[float] = 1.5
    units: ClassVar[dict[str, Unit]] = Stepped.units | {"stiffness": Hertz.units["stiffness"]}

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """max(0, K p^ν + C s p′), by :meth:`root_force`."""
        return self.root_force(penetration ** (1 / self.root), rate)

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """max(0, K q^{mν} + C s p′)."""
        penetration = root**self.root
        spring = self.stiffness * penetration * root ** (self.root * (self.power - 1))
        force = spring + self.damping * self.step(penetration) * rate
        return np.where(np.real(force) > 0, force, 0.0)

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """(p - d)(K + C s p′/p^ν), of which the second factor is not 0 at the surface."""
        d = self.depth
        p = penetration
        near = (3 - 2 * p / d) / d**2 * p ** (2 - self.power)
        deep = np.maximum(p, d) ** -self.power
        return (p - d) * (self.stiffness + self.damping * np.where(p < d, near, deep) * rate)


@dataclass(frozen=True, repr=False)
class LinearAdamsImpact(AdamsImpact):
    """The function IMPACT with the exponent ν = 1.

    Parameters
    ----------
    stiffness, damping, depth : float or array
        K > 0, C ≥ 0 and d > 0, the depth of full damping.

    Examples
    --------
    >>> law = LinearAdamsImpact(2.0, 3.0, 8.0)
    >>> [float(law.force(4.0, rate)) for rate in (2.0, -20.0)]
    [11.0, 0.0]
    """

    name: ClassVar[str] = "adams-impact-linear"
    root: ClassVar[int] = 1
    power: ClassVar[float] = 1.0
    units: ClassVar[dict[str, Unit]] = Stepped.units


@dataclass(frozen=True, repr=False)
class SimscapeContact(Stepped):
    """The contact of Simscape Multibody: spring and damper are stepped.

    Parameters
    ----------
    stiffness, damping, depth : float or array
        K > 0, C ≥ 0 and d > 0, the width of the transition region.

    Examples
    --------
    >>> law = SimscapeContact(2.0, 3.0, 8.0)
    >>> float(law.force(4.0, 2.0)), float(law.grip(6.0, -4.0))
    (7.0, 0.0)
    """

    name: ClassVar[str] = "simscape-contact"
    root: ClassVar[int] = 1
    release = Release.FORCE

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """s (K p + C p′)."""
        return self.step(penetration) * (self.stiffness * penetration + self.damping * rate)

    @property
    def lag(self) -> Any:
        """κ = C/K, because the force vanishes where p + κ p′ = 0."""
        return self.damping / np.asarray(self.stiffness, dtype=float)

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p - d."""
        return penetration - self.depth + 0 * rate
