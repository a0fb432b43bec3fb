r"""MuJoCo's contact: its impedance d(p) scales the load on the ball and, if d varies, the force.

MuJoCo gives a contact the acceleration ``a₁ = (1 - d) a₀ - d (b v + k x)``, with a₀ that of all
other forces, x = -p, and from a direct ``solref`` ``b = 2ζϖ/d_max``, ``k = ϖ² d/d_max²``. With
``s = d/d_max`` ::

    p″ = (1 - d) a - f,   f = s (ϖ² s p + 2ζϖ p′),   force on the ball  f + d a ≥ 0

The impedance grows from d_min at the surface to d_max at the depth W, by a power ν on both sides
of the midpoint c, ::

    d = d_min + (d_max - d_min) y(p/W),   y(x) = x^ν/c^{ν-1},   1 - (1 - x)^ν/(1 - c)^{ν-1}

for x ≤ c and c ≤ x ≤ 1. Its slope or curvature has steps at p = cW and p = W, which count as kinks
of the force. The ball is released where the force vanishes, or where p = 0 if that comes first.

If d is constant, s = 1, and d scales the load only. Without load the impact is then that of the
spring-damper with its force release, with the same t_c, r and D. The effect of a load a on the ball
in contact is 1 - d times that on the spring-damper. At the release, where p + κ p′ = -d a/ϖ², the
acceleration without load is zero, so that ∂p′_e/∂a is also 1 - d times that of the spring-damper,
whereas the whole load acts during the flights. Hence, with κ = 2ζ/ϖ, ::

    σ_d = (1 - r) D - (2 - d) κ r = σ + d κ r

In a steady contact without a flight both p and the force remain positive, which requires ::

    Λ ≤ |ϖ² - 1 + 2iζϖ| / max(ϖ², |ϖ² - d + 2iζϖ|)

If d varies, r depends on the speed, and the signature comes from free impacts; for ζ ≥ 1 as well,
where r and D have other formulas and that of σ_d holds. Physical parameters: ``k/m = Ω² ϖ²``,
``c/m = 2Ωζϖ``, and the width is W g/Ω².

Source: MuJoCo's documentation, *Solver parameters*, read with the engine itself.
"""

from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from bouncing_ball_beyond.inherited.errors import require
from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.contact_law import OscillatorLaw
from bouncing_ball_beyond.models.laws.force_law import NUMBER, Unit
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw
from bouncing_ball_beyond.models.spring_damper import SpringDamper


class _Piece(NamedTuple):
    """``s = level + growth max(start + slope p, 0)^ν``, for depths on one side of the midpoint.

    ``low`` marks the balls up to the depth cW, and ``deep`` those from the depth W on.
    """

    level: np.ndarray
    growth: np.ndarray
    start: np.ndarray
    slope: np.ndarray
    low: np.ndarray
    deep: np.ndarray | bool


@dataclass(frozen=True, repr=False)
class Impedance(LoadedLaw, OscillatorLaw):
    """A spring-damper on which only the share 1 - d of the load acts.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ ≥ 0. Because the force only pushes, the ball rebounds for ζ ≥ 1 as well.
    share : float or array
        d_max in [0, 1), the impedance from the depth ``width`` on; MuJoCo's default is 0.95.
    at_surface : float or array, optional
        d_min in [0, 1); by default d_max, so that d is constant. MuJoCo's default is 0.9.
    width, midpoint, power : float or array
        W > 0 in units of g/Ω², c in (0, 1) and ν ≥ 1.

    Raises
    ------
    ModelError
        If a number is outside its range.

    Examples
    --------
    >>> law = Impedance(2.0, 0.5, 0.75)
    >>> float(law.grip(1.0, -2.0)), float(law.under(4.0).grip(1.0, -2.0))
    (0.0, 0.75)
    >>> Impedance(2.0, 0.5, 0.75, 0.25, width=4.0).impedance(np.array([0.0, 1.0, 3.0, 5.0]))
    array([0.25  , 0.3125, 0.6875, 0.75  ])
    """

    share: float | np.ndarray = 0.95
    at_surface: Any = None
    width: float | np.ndarray = 1.0
    midpoint: float | np.ndarray = 0.5
    power: float | np.ndarray = 2.0

    name: ClassVar[str] = "impedance"
    units: ClassVar[dict[str, Unit]] = OscillatorLaw.units | {
        "share": NUMBER,
        "at_surface": NUMBER,
        "width": Unit("m", 0, 1, 0),
        "midpoint": NUMBER,
        "power": NUMBER,
    }

    def __post_init__(self):
        super().__post_init__()
        if self.at_surface is None:
            object.__setattr__(self, "at_surface", self.share)
        for d in (self.share, self.at_surface):
            require((d >= 0) & (d < 1), d, "impedance d", "in [0, 1)")
        check_positive(self.width, "width W")
        require((self.midpoint > 0) & (self.midpoint < 1), self.midpoint, "midpoint", "in (0, 1)")
        require(self.power >= 1, self.power, "power", "at least 1")

    # Cached, because each evaluation of the force needs it.
    @cached_property
    def _varies(self) -> np.ndarray:
        return np.not_equal(self.share, self.at_surface)

    @cached_property
    def has_kink(self) -> bool:
        """Whether d depends on the depth."""
        return bool(np.any(self._varies))

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """(p - cW)(p - W), which changes its sign at both depths.

        For the continued law it changes its sign only at the ends of the piece, because a ball may
        pass both depths within a panel.
        """
        low = deep = np.False_
        if self._piece is not None:
            low = self._piece.low
            deep = self._piece.deep
        at_midpoint = np.where(deep, 1.0, penetration - self.midpoint * self.width)
        at_width = np.where(low, -1.0, penetration - self.width)
        return np.where(self._varies, at_midpoint * at_width, 1.0)

    # The formula of s that holds at all depths of a continued law.
    _piece: ClassVar[Any] = None

    def _side(self, low: np.ndarray, deep: np.ndarray | bool = False) -> _Piece:
        """The formula of s for depths up to the midpoint where ``low``, and beyond it elsewhere."""
        c = self.midpoint
        upper = 1 - np.asarray(c)
        least = np.where(self._varies, self.at_surface / np.asarray(self.share), 1.0)
        return _Piece(
            level=np.where(low, least, 1.0),
            growth=np.where(low, (1 - least) * c, (least - 1) * upper),
            start=np.where(low, 0.0, 1 / upper),
            slope=np.where(low, 1 / (c * self.width), -1 / (upper * self.width)),
            low=low,
            deep=deep,
        )

    def continued(self, penetration: np.ndarray, side: np.ndarray) -> Self:
        """The law whose s has the formula of one side of the midpoint at all depths of a ball."""
        law = copy(self)
        low = (side > 0) & (penetration < (1 + self.midpoint) / 2 * self.width)
        object.__setattr__(law, "_piece", self._side(low, deep=(side > 0) & ~low))
        return law

    def _ratio(self, penetration: np.ndarray) -> Any:
        """The ratio s = d/d_max; 1 if d is constant, even where it is 0."""
        if not self.has_kink:
            return 1.0
        piece = self._piece
        if piece is None:
            piece = self._side(np.real(penetration) < self.midpoint * self.width)
        rise = np.maximum(piece.start + piece.slope * penetration, 0.0)
        return piece.level + piece.growth * rise**self.power

    def impedance(self, penetration: np.ndarray) -> np.ndarray:
        """The impedance d(p), of the shape of p."""
        return self.share * self._ratio(penetration) + 0 * penetration

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """f + d a, the whole force on the ball; without a load f = s (ϖ² s p + 2ζϖ p′)."""
        s = self._ratio(penetration)
        omega = self.frequency_ratio
        spring = omega * (omega * (s * penetration) + 2 * self.damping_ratio * rate)
        return s * (spring + self.share * self.load)

    def grip(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """s p + κ p′ + d_max a/ϖ²."""
        lag = 2 * np.asarray(self.damping_ratio) / self.frequency_ratio
        held = self.share / np.asarray(self.frequency_ratio) ** 2 * self.load
        return self._ratio(penetration) * penetration + lag * rate + held

    @property
    def constant_signature(self) -> Instant | None:
        """The signature of the spring-damper with σ_d in place of σ; None if d varies or ζ ≥ 1."""
        if self.has_kink or np.any(np.asarray(self.damping_ratio) >= 1):
            return None
        spring = SpringDamper(self.frequency_ratio, self.damping_ratio, Release.FORCE)
        free = spring.signature(1.0)
        return free._replace(load=free.load + self.share * spring.lag * free.restitution)

    @property
    def permanent_contact(self) -> Any:
        """The largest Λ at which a steady contact never releases the ball; None if d varies."""
        if self.has_kink:
            return None
        omega = np.asarray(self.frequency_ratio)
        stiffness = omega * omega
        loss = 2 * np.asarray(self.damping_ratio) * omega
        held = np.maximum(stiffness, np.hypot(stiffness - self.share, loss))
        return np.hypot(stiffness - 1, loss) / held

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ that gives a restitution coefficient r in (e⁻², 1] with the force release."""
        return float(damping_ratio(restitution, Release.FORCE))
