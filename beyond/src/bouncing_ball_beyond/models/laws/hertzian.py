r"""Contact laws with Hertz' stiffness, or a linear one, and one damping parameter.

The force is ``f = K p^ν`` plus a damping force with the parameter C. A ball of mass m on a plane
has ``k x^{3/2}`` with k = (4/3) E* √R, and on a table of frequency Ω under gravity g therefore
``K = k √g/(m Ω³)``. The three laws of a sphere differ in their damping.

**Hunt and Crossley:** ``f = K p^{3/2} (1 + C p′)``, released at p = 0, where the force vanishes
too. The force never pulls a free ball, because the ball leaves with p′ > -1/C. The restitution
coefficient depends on C v alone and falls with the speed, as 1 - (2/3) C v for a slow impact. The
physical force ``k x^{3/2} (1 + λ ẋ)`` has ``C = λ g/Ω``. With a linear spring, as in Drake's point
contact, the restitution coefficient is the same function of C v.

Source: K. H. Hunt and F. R. E. Crossley, *Coefficient of restitution interpreted as damping in
vibroimpact*, Journal of Applied Mechanics 42 (1975) 440-445, as quoted by Simbody
(``HuntCrossleyContact.h``: k xⁿ (1 + (3/2) c v), n = 3/2 for a sphere, and e = 1 - c v at low
speed; its c is (2/3) λ).

**Kuwabara and Kono**, and Brilliantov et al., the viscoelastic contact:
``f = K (p^{3/2} + C √p p′)``, released where the force vanishes, p + C p′ = 0, because the surfaces
do not adhere; the contact is still deformed when the ball leaves. The restitution coefficient
depends on C v^{1/5} K^{2/5} alone and falls with the speed, as 1 - 1.15 C K^{2/5} v^{1/5} for a
slow impact. The physical force ``k (x^{3/2} + (3/2) A √x ẋ)``, where A is a time that describes the
dissipation, has ``C = (3/2) A Ω``.

Sources: G. Kuwabara and K. Kono, Japanese Journal of Applied Physics 26 (1987) 1230-1233, as quoted
by the CGNS standard (``HertzKuwabaraKono``; the last page from memory); N. V. Brilliantov,
F. Spahn, J.-M. Hertzsch and T. Pöschel, Physical Review E 53 (1996) 5382-5392, as quoted by LAMMPS
(``pair_style gran/hooke``); for the release T. Schwager and T. Pöschel, Physical Review E 78 (2008)
051304, as quoted by the toolbox ChattAbhi/Approx-ViscoElastic-CoR.

**Tsuji**, which codes for granular matter use: ``f = K p^{3/2} + C √K p^{1/4} p′``, released at
p = 0. With q = p^{5/4} and ds = p^{1/4} dt a free impact is linear, ::

    d²q/ds² + C √K dq/ds + (5/4) K q = 0

so that the restitution coefficient does not depend on the speed, and
``C = √5 (-ln r)/√(π² + ln² r)`` exactly; for C ≥ √5 the ball does not leave. The physical force
``k x^{3/2} + α √(m k) x^{1/4} ẋ`` has C = α.

Sources: Y. Tsuji, T. Tanaka and T. Ishida, Powder Technology 71 (1992) 239-250, as quoted by LAMMPS
(``pair_style granular``); D. Antypov and J. A. Elliott, *On an analytical solution for the damped
Hertzian spring*, Europhysics Letters 94 (2011) 50004, as quoted by Yade (``doc/references.bib``;
its sources give the formula as Eq. 17). Y. T. Feng, arXiv:2603.27764 (2026), gives the same change
of variable and the formula for any power (only its abstract was read).
"""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import require
from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.models.damping import Release, check_damping
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.force_law import NUMBER, Scaled, Unit


@dataclass(frozen=True, repr=False)
class Hertz(ContactLaw):
    """``f = K p^ν`` plus a damping force, by default with Hertz' power ν = 3/2.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Raises
    ------
    ModelError
        If K or C is outside its range.
    """

    power: ClassVar[float] = 1.5
    group_exponent: ClassVar[float] = 0.0
    """The exponent of the impact speed in the dissipation ``group``."""
    stiffness: float | np.ndarray
    damping: float | np.ndarray

    units: ClassVar[dict[str, Unit]] = {
        "stiffness": Unit("N/m^1.5", 1, -0.5, -2),
        "damping": NUMBER,
    }

    def __post_init__(self):
        super().__post_init__()
        check_positive(self.stiffness, "stiffness K")
        check_damping(self.damping, "damping C")

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f(p, p′), by :meth:`root_force`, which is a polynomial in the root q = √p."""
        return self.root_force(np.sqrt(penetration), rate)

    @abstractmethod
    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f as a function of q = p^{1/m} and p′."""

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with K = v²/P^{1+ν}, ν the power of p, and C = ``group`` :meth:`damping_unit`."""
        scale = np.asarray(length, dtype=float)
        v = np.asarray(speed, dtype=float)
        stiffness = v * v / scale ** (1 + cls.power)
        return cls(stiffness, group * cls.damping_unit(scale, v) + 0 * stiffness)

    def scaled(self, speed: np.ndarray) -> Scaled:
        """With P = (v²/K)^{1/(1+ν)} and C in its unit."""
        of_length = 1 / (1 + self.power)
        length = (speed * speed / self.stiffness) ** of_length
        unit = self.damping_unit(length, speed)
        return Scaled(
            group=self.damping / unit + 0 * length,
            time=length / speed,
            group_exponent=self.group_exponent,
            time_exponent=2 * of_length - 1,
        )

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> Any:
        """The unit of C in terms of the scales P and v; 1 by default, where C is a number."""
        return 1.0


@dataclass(frozen=True, repr=False)
class HuntCrossley(Hertz):
    """Hertz contact with damping proportional to the elastic force.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Examples
    --------
    >>> float(HuntCrossley(2.0, 0.5).force(4.0, 1.0))
    24.0
    """

    name: ClassVar[str] = "hunt-crossley"
    formula: ClassVar[str] = "k x^1.5 (1 + C ẋ)"
    group_exponent: ClassVar[float] = 1.0

    units: ClassVar[dict[str, Unit]] = Hertz.units | {"damping": Unit("s/m", 0, -1, 1)}

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K q³ (1 + C p′)."""
        return self.stiffness * (root * root * root) * (1 + self.damping * rate)

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """The unit 1/v of C."""
        return 1 / speed


@dataclass(frozen=True, repr=False)
class LinearHuntCrossley(HuntCrossley):
    """A linear spring with Hunt and Crossley's damping, as in Drake's point contact.

    The restitution coefficient does not depend on the power of p.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Examples
    --------
    >>> float(LinearHuntCrossley(2.0, 0.5).force(4.0, 1.0))
    12.0
    """

    name: ClassVar[str] = "hunt-crossley-linear"
    formula: ClassVar[str] = "k x (1 + C ẋ)"
    root: ClassVar[int] = 1
    power: ClassVar[float] = 1.0
    units: ClassVar[dict[str, Unit]] = HuntCrossley.units | {"stiffness": Unit("N/m", 1, 0, -2)}

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K p (1 + C p′)."""
        return self.stiffness * penetration * (1 + self.damping * rate)


@dataclass(frozen=True, repr=False)
class KuwabaraKono(Hertz):
    """Viscoelastic Hertz contact that does not pull.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C ≥ 0.

    Examples
    --------
    >>> law = KuwabaraKono(2.0, 0.5)
    >>> float(law.force(4.0, 1.0)), float(law.grip(4.0, -8.0))
    (18.0, 0.0)
    """

    name: ClassVar[str] = "kuwabara-kono"
    formula: ClassVar[str] = "k (x^1.5 + C √x ẋ)"
    group_exponent: ClassVar[float] = 0.2
    release = Release.FORCE

    units: ClassVar[dict[str, Unit]] = Hertz.units | {"damping": Unit("s", 0, 0, 1)}

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K q (q² + C p′)."""
        return self.stiffness * root * (root * root + self.damping * rate)

    @property
    def lag(self) -> float | np.ndarray:
        """C, because the force vanishes where p + C p′ = 0."""
        return self.damping

    @staticmethod
    def damping_unit(length: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """The unit P/v of C."""
        return length / speed


def tsuji_damping(restitution: ArrayLike) -> np.ndarray:
    """``C = √5 (-ln r)/√(π² + ln² r)`` for r in (0, 1]; the range of r is not checked.

    Examples
    --------
    >>> float(tsuji_damping(1.0))
    0.0
    """
    decrement = -np.log(np.asarray(restitution, dtype=float)) + 0.0
    return np.sqrt(5) * decrement / np.hypot(np.pi, decrement)


@dataclass(frozen=True, repr=False)
class Tsuji(Hertz):
    """Hertz contact whose restitution coefficient is the same at every speed.

    Parameters
    ----------
    stiffness, damping : float or array
        K > 0 and C in [0, √5).

    Raises
    ------
    ModelError
        If K or C is outside its range.

    Examples
    --------
    >>> float(Tsuji(4.0, 0.5).force(16.0, 1.0))
    258.0
    """

    name: ClassVar[str] = "tsuji"
    formula: ClassVar[str] = "k x^1.5 + C √(m k) x^0.25 ẋ"
    root: ClassVar[int] = 4

    def __post_init__(self):
        super().__post_init__()
        c = self.damping
        require(c < np.sqrt(5), c, "damping C", "below √5: with more the ball does not leave")

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K p^{3/2} + C √K p^{1/4} p′."""
        root = np.sqrt(penetration)
        loss = self.damping * np.sqrt(self.stiffness) * rate
        return self.stiffness * penetration * root + loss * np.sqrt(root)

    def root_force(self, root: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """K q⁶ + C √K q p′."""
        square = root * root
        loss = self.damping * np.sqrt(self.stiffness)
        return self.stiffness * (square * square * square) + loss * root * rate

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """C that gives a restitution coefficient r in (0, 1]."""
        return float(tsuji_damping(restitution))
