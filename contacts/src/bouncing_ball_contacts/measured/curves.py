r"""Restitution and contact time over the impact speed, for each contact law.

In units of its scales P and P/v a free impact depends on one number, the dissipation *group*, which
is proportional to a power of the speed (:mod:`bouncing_ball_beyond.models.laws.force_law`).
Relative to their values at a speed v₀ therefore ::

    r(v) = R(G (v/v₀)^a),    T(v) = τ (v/v₀)^b D(G (v/v₀)^a)

with the functions R and D of the law, and two parameters: the group G at v₀ and the time τ = P/v₀.
Hence restitution coefficients alone determine G, and never a stiffness, which takes a contact time.
If a = 0, r is the same at every speed, and r itself is the parameter.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, one_of
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.hertzian import (
    HuntCrossley,
    KuwabaraKono,
    LinearHuntCrossley,
    Tsuji,
)
from bouncing_ball_beyond.models.laws.law_of_impact import reference
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.named_laws import law_named
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.engines.laws import LAWS

# The logarithms of the groups that are searched for a restitution coefficient, which falls with
# the group. Few of them are computed, because each costs as much as a fit.
_GROUPS = np.linspace(-30.0, 4.0, 341)
# The least and the greatest constant r, so that a search cannot leave the range of r.
_LEAST, _MOST = 1e-6, 1.0


@dataclass(frozen=True)
class LawCurve:
    """r(v) and T(v) of one kind of contact law.

    The parameter θ is ln G, or r if it does not depend on the speed.

    Parameters
    ----------
    name : str
    kind : type of ContactLaw or None
        None for a restitution coefficient without a contact.
    exponent, time_exponent : float
        a and b.
    """

    name: str
    kind: type[ContactLaw] | None
    exponent: float = 0.0
    time_exponent: float = 0.0

    @property
    def is_constant(self) -> bool:
        """Whether r is the same at every speed."""
        return self.exponent == 0

    def restitution(self, theta: float, ratio: ArrayLike) -> np.ndarray:
        """r at the speeds v = ``ratio`` v₀.

        Examples
        --------
        >>> curve_named("tsuji").restitution(0.8, [0.5, 2.0]).tolist()
        [0.8, 0.8]
        """
        x = np.asarray(ratio, dtype=float)
        if self.kind is None or self.is_constant:
            return np.full(x.shape, min(max(theta, _LEAST), _MOST))
        # An array of its own, because the impacts are kept.
        return 1.0 * self._free(self.kind, theta, x).restitution

    def duration(self, theta: float, ratio: ArrayLike) -> np.ndarray:
        """T/τ at the speeds v = ``ratio`` v₀.

        Raises
        ------
        ModelError
            If there is no contact.
        """
        if self.kind is None:
            raise ModelError("a restitution coefficient alone has no contact time")
        x = np.asarray(ratio, dtype=float)
        if self.is_constant:
            shape = np.full(x.shape, reference(self.kind, min(theta, _MOST))[1])
        else:
            shape = self._free(self.kind, theta, x).duration
        return x**self.time_exponent * shape

    def slope(self, theta: float, ratio: ArrayLike) -> np.ndarray:
        """∂r/∂θ at the speeds v = ``ratio`` v₀.

        Examples
        --------
        >>> kono, step = curve_named("kuwabara-kono"), 1e-5
        >>> up, down = (kono.restitution(-2.0 + s * step, 3.0) for s in (1, -1))
        >>> bool(abs((up - down) / (2 * step) - kono.slope(-2.0, 3.0)) < 1e-9)
        True
        """
        x = np.asarray(ratio, dtype=float)
        if self.kind is None or self.is_constant:
            return np.ones(x.shape)
        # At a speed of 1 the derivative with respect to ln v is a times that with respect to ln G.
        return np.asarray(self._free(self.kind, theta, x).d_restitution) / self.exponent

    def trend(self, theta: float, ratio: ArrayLike) -> np.ndarray:
        """v dr/dv at the speeds v = ``ratio`` v₀.

        Examples
        --------
        >>> kono, step = curve_named("kuwabara-kono"), 1e-5
        >>> up, down = (kono.restitution(-2.0, 3.0 * np.exp(s * step)) for s in (1, -1))
        >>> bool(abs((up - down) / (2 * step) - kono.trend(-2.0, 3.0)) < 1e-9)
        True
        """
        x = np.asarray(ratio, dtype=float)
        if self.kind is None or self.is_constant:
            return np.zeros(x.shape)
        # The group is proportional to v to the power a.
        return self.exponent * self.slope(theta, x)

    def _free(self, kind: type[ContactLaw], theta: float, ratio: np.ndarray) -> Instant:
        """Impacts at the speeds v = ``ratio`` v₀, in units of their scales."""
        return _free(kind, theta + self.exponent * np.log(ratio))

    def parameter(self, restitution: float) -> float:
        """θ of the law that has this r at v₀, close enough for the start of a fit."""
        if self.kind is None or self.is_constant:
            return restitution
        low = 0
        high = _GROUPS.size - 1
        while high - low > 1:
            middle = (low + high) // 2
            if _free(self.kind, _GROUPS[middle]).restitution >= restitution:
                low = middle
            else:
                high = middle
        sides = _GROUPS[[low, high]]
        return float(np.interp(-restitution, -_free(self.kind, sides).restitution, sides))


def _free(kind: type[ContactLaw], logarithm: np.ndarray) -> Instant:
    """Impacts with these logarithms of their groups, in units of their scales."""
    log = np.clip(logarithm, _GROUPS[0], _GROUPS[-1])
    return _impacts(kind, log.shape, log.tobytes())


# A fit asks for r and for its derivative at the same groups.
@lru_cache(maxsize=4)
def _impacts(kind: type[ContactLaw], shape: tuple[int, ...], logarithms: bytes) -> Instant:
    group = np.exp(np.frombuffer(logarithms).reshape(shape))
    return Signature(kind.of_scales(group, 1.0, 1.0))(1.0)


def _of(kind: type[ContactLaw]) -> LawCurve:
    scaled = kind.of_scales(0.1, 1.0, 1.0).scaled(np.ones(1))
    if scaled is None:
        return LawCurve(kind.name, kind)
    return LawCurve(kind.name, kind, scaled.group_exponent, scaled.time_exponent)


_KINDS = (SpringDamper, ElastoBacklash, Tsuji, KuwabaraKono, HuntCrossley, LinearHuntCrossley)
CONSTANT = "restitution"
CURVES = {CONSTANT: LawCurve(CONSTANT, None)} | {kind.name: _of(kind) for kind in _KINDS}
"""The laws that are fitted, by name. The paper's two models are the first two."""


def curve_named(name: str) -> LawCurve:
    """The curve of the law with this name.

    Raises
    ------
    ModelError
        If there is no such law, or its impacts have no scales.
    """
    return one_of("law", name, CURVES) if name == CONSTANT else _contact_curve(name)


def _contact_curve(name: str) -> LawCurve:
    kind = law_named(name, LAWS)
    return one_of("law for a fit", kind.name, CURVES)
