r"""The signature of a contact law, from its free impacts.

A free impact of speed v ends after D(v) with p_e and p′_e = -r v, and its force has
its centroid at ``t_c = (p_e + D r v)/((1 + r) v)``. A small constant load a during
the contact changes p′_e by a known derivative, and the continued flights before and
after it by a t_c and a (D - t_c), so that at the speed of the instant ::

    σ = -∂p′_e/∂a + (D - t_c) - t_c d(r v)/dv

All of it comes from one collocation at each speed. Between speeds the four
functions are smooth in ln v: Chebyshev interpolation in panels, each a factor of
eight of the speed wide and computed when it is first asked for.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.collocation import contacts
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.signature import Instant, Signature
from bouncing_ball.errors import ModelError

# Width of a panel in ln v and its nodes: a pole of r(v) at ln v = x ± iπ, like that of
# 1/(1 + C v), leaves 6⁻²⁴.
_WIDTH = np.log(8.0)
_NODES = 24
# Speeds beyond are those of the ends: no impact is so slow or so fast.
_SLOWEST, _FASTEST = 1e-30, 1e30


def free_impact(law: ContactLaw, speed: ArrayLike) -> Instant:
    """The signature at impact speeds v > 0, each by its own collocation.

    Its derivatives in v are left at zero but for that of r.

    Examples
    --------
    An elastic contact pushes symmetrically, and its load cancels:

    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> impact = free_impact(HuntCrossley(100.0, 0.0), 2.0)
    >>> bool(abs(impact.delay / impact.duration - 0.5) < 1e-12)
    True
    >>> round(float(impact.restitution), 12), abs(round(float(impact.load), 12))
    (1.0, 0.0)
    """
    v = np.asarray(speed, dtype=float)
    end = contacts(law, v, weight=0.0)
    if not np.all(np.isfinite(end.duration)):
        lost = np.broadcast_to(v, end.duration.shape)[np.isnan(end.duration)][0]
        raise ModelError(
            f"{law.name}: no end of a free impact of speed {lost:.3g} was found; the law must let "
            "the ball go within a dozen oscillations: is it adhesive, or damped too strongly?"
        )
    by_speed, by_load = end.jacobian[..., 2, 1], end.jacobian[..., 2, 3]
    r = -end.rate / v
    delay = (end.penetration + end.duration * r * v) / ((1 + r) * v)
    load = -by_load + (end.duration - delay) + delay * by_speed
    return Instant(delay, r, load, end.duration, d_restitution=(-by_speed - r) / v)


@lru_cache(maxsize=4096)
def _panel(law_type: type[ContactLaw], values: tuple, number: int) -> np.ndarray:
    """Chebyshev coefficients of t_c, r, σ and D over a panel, shape (nodes, 4)."""
    angle = np.pi * (np.arange(_NODES) + 0.5) / _NODES
    log = (number + (np.cos(angle) + 1) / 2) * _WIDTH
    instant = free_impact(law_type(*values), np.exp(log))
    rows = np.stack([instant.delay, instant.restitution, instant.load, instant.duration], axis=1)
    waves = np.cos(np.outer(np.arange(_NODES), angle)) * (2 / _NODES)
    waves[0] /= 2
    return waves @ rows


@dataclass(frozen=True, repr=False)
class LawSignature(Signature):
    """The signature of any contact law, tabulated.

    Parameters
    ----------
    law : ContactLaw
        A single one.

    Raises
    ------
    ModelError
        If the law has arrays of parameters, or does not let the ball go.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
    >>> instant = LawSignature(Tsuji(50.0, tsuji_damping(0.7)))([1.0, 2.0, 3.0])
    >>> instant.restitution.round(12).tolist()
    [0.7, 0.7, 0.7]
    """

    law: ContactLaw

    def __post_init__(self):
        if self.law.shape:
            raise ModelError("the signature of a contact law is tabulated for one law, not many")

    @property
    def label(self) -> str:
        """The law and its parameters."""
        return self.law.label

    def __call__(self, speed: ArrayLike) -> Instant:
        """The signature of impacts with speeds v > 0 at the instant."""
        v = np.clip(np.asarray(speed, dtype=float), _SLOWEST, _FASTEST)
        log = np.log(v) / _WIDTH
        number = np.floor(np.where(np.isnan(log), 0.0, log)).astype(int)
        values = np.full((4, *v.shape), np.nan)
        slopes = np.full((4, *v.shape), np.nan)
        key = tuple(self.law.fields())
        for panel in np.unique(number):
            coefficients = _panel(type(self.law), key, int(panel))
            here = number == panel
            x = 2 * (log[here] - panel) - 1
            values[:, here] = np.polynomial.chebyshev.chebval(x, coefficients)
            derived = np.polynomial.chebyshev.chebder(coefficients) * (2 / _WIDTH)
            slopes[:, here] = np.polynomial.chebyshev.chebval(x, derived) / v[here]
        return Instant(*values, *slopes[:3])
