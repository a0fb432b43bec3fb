r"""The effect of a contact on the motion outside it: the signature of an impact.

In the table's frame the ball obeys δ″ = -a + F, with the load ``a = 1 - Λ sin τ``
and F the contact force over the mass. Continue the free flights before and
after the contact into the contact. Both have the acceleration -a, so that their
distance depends on F only, whatever the motion of the table::

    δ_out(t) - δ_in(t) = ∫ F(s) (t - s) ds = J (t - t_c),    J = ∫ F ds

They meet at one instant, the centroid of the force, ``t_c = ∫ s F ds / J``. For the motion
outside, the contact is equivalent to an instantaneous impact at this instant, below the
table's level, with the restitution ``r_c = -δ′_out/δ′_in`` of the continued
flights. This is exact. To second order in the duration of the contact
the law enters only through functions of the speed v = -δ′_in:

* the *delay* t_c(v), from the start of contact to the instant, and with it the
  depth h = v t_c of the instant below the table;
* the *restitution* r(v) of the free impact, without load;
* the *load sensitivity* σ(v), ``r_c = r + σ a/v``, with v and a at the instant;
* the *duration* D(v) of the contact, which determines only when the ball leaves.

For the linear contact they are constants in closed form. The contact ends where δ + κ δ′ = 0, see
:mod:`bouncing_ball_beyond.models.damping`. The free impact ends with δ′ = r v and
δ = -κ r v, hence from F = δ″ and one integration by parts ::

    t_c = (D δ′_b - δ_b)/((1 + r) v) = r (D + κ)/(1 + r)

A constant load a adds -a G to δ, ``G = (1 - g′ - 2ζϖ g)/ϖ²`` with g the impulse
response. The release then comes later by ``(1 + r) a/(r v ϖ²)``, and the
velocity there is less by ``[2ζ(1 + r)/ϖ - κ] a``, to first order. The load also acts on the
continued flights: during D - t_c, from the release back to the instant, with weight 1, and during
t_c, from the start to the instant, with weight -r. This adds ``[D - (1 + r) t_c] a``. Together ::

    σ = (1 - r)(D + κ) - 2ζ (1 + r)/ϖ

For any other law they are computed from free impacts. A free impact of speed v ends after D(v)
with p_e and p′_e = -r v, and the centroid of its force is ``t_c = (p_e + D r v)/((1 + r) v)``. A
small constant load a changes p′_e by its derivative ∂p′_e/∂a, and the velocities of the continued
flights before and after the instant by a t_c and a (D - t_c), so that at the speed v of
the instant ::

    σ = -∂p′_e/∂a + (D - t_c) - t_c d(r v)/dv

One collocation at each speed gives all four numbers. Between these speeds the four functions are
interpolated by Chebyshev polynomials in ln v, in which they are smooth. A panel covers a factor
of eight in speed, and is computed when it is first needed. In units of its scales P and P/v the
impact of a Hertzian law depends on its dissipation group alone, a power of v, so that one table
over the logarithm of the group serves all laws of a kind. At a speed at which the deepest point of
the impact just reaches a kink of the force, the functions have only a few derivatives. The panels
of such laws are therefore shorter, and the errors there are about 10⁻⁶ of t_c, σ and D, and 10⁻⁸
of r.

All quantities are dimensionless; all functions broadcast.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.numerics.arrays import Batch
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.collocation import contacts
from bouncing_ball_beyond.models.laws.force_law import ForceLaw, Scaled

# Width of a panel in ln v, and its number of nodes: with a pole of r(v) at ln v = x ± iπ, like
# that of 1/(1 + C v), the interpolation error is of the order of 6⁻²⁴.
_WIDTH = np.log(8.0)
_NODES = 24
# Each panel is divided into this number of panels for a law with kinks at given depths.
_PARTS = 16
# Speeds are clipped to this range, beyond which no impact lies.
_SLOWEST, _FASTEST = 1e-30, 1e30


def computed(law: ForceLaw, speed: ArrayLike) -> Instant:
    """The signature of :meth:`.ContactLaw.signature`, by one collocation for each speed."""
    v = np.asarray(speed, dtype=float)
    end = contacts(law, v, weight=0.0)
    if not np.all(np.isfinite(end.duration)):
        lost = np.broadcast_to(v, end.duration.shape)[np.isnan(end.duration)][0]
        raise _unending(law.name, lost)
    by_speed = end.jacobian[..., 2, 1]
    by_load = end.jacobian[..., 2, 3]
    r = -end.rate / v
    delay = (end.penetration + end.duration * r * v) / ((1 + r) * v)
    load = -by_load + (end.duration - delay) + delay * by_speed
    return Instant(
        delay=delay,
        restitution=r,
        load=load,
        duration=end.duration[()],
        d_restitution=(-by_speed - r) / v,
    )


def _unending(name: str, speed: float) -> ModelError:
    return ModelError(
        f"{name}: a free impact of speed {speed:.3g} does not end within a dozen oscillations, "
        "because the law is adhesive or damped too strongly, or because its force is not analytic "
        "in p^(1/m) with its root m"
    )


def _width(law: ForceLaw) -> float:
    """Width of a panel of the interpolation, in ln v."""
    return _WIDTH if law.is_smooth_by_speed else _WIDTH / _PARTS


@lru_cache(maxsize=4096)
def _of_groups(kind: type[ForceLaw], groups: tuple[float, ...]) -> np.ndarray:
    """t_c, r, σ and D of the impacts with m groups, in units of their scales, shape (4, m)."""
    return np.array(computed(kind.of_scales(np.array(groups), 1.0, 1.0), 1.0)[:4])


@lru_cache(maxsize=4096)
def _panel(law: ForceLaw | type[ForceLaw], number: int, width: float) -> np.ndarray:
    """Chebyshev coefficients of t_c, r, σ and D over a panel, shape (nodes, 4).

    Of a law, panels divide ln v; of a kind of laws, they divide the logarithm of the group, and the
    numbers are in units of the scales. They are NaN if an impact of the panel does not end.
    """
    x = np.polynomial.chebyshev.chebpts1(_NODES)
    at = np.exp((number + (x + 1) / 2) * width)
    try:
        if isinstance(law, type):
            instant = computed(law.of_scales(at, 1.0, 1.0), 1.0)
        else:
            instant = computed(law, at)
    except ModelError:
        return np.full((_NODES, 4), np.nan)
    return np.polynomial.chebyshev.chebfit(x, np.stack(instant[:4], axis=1), _NODES - 1)


def _interpolated(
    law: ForceLaw | type[ForceLaw], at: np.ndarray, width: float
) -> tuple[np.ndarray, np.ndarray]:
    """t_c, r, σ and D, and their derivatives with respect to the logarithm of ``at``, shape (4, m);
    ``at`` are speeds, or groups of a kind of laws, shape (m,).
    """
    log = np.log(at) / width
    number = np.floor(log).astype(int)
    values = np.empty((4, at.size))
    slopes = np.empty((4, at.size))
    for panel in np.unique(number):
        coefficients = _panel(law, int(panel), width)
        here = number == panel
        x = 2 * (log[here] - panel) - 1
        values[:, here] = np.polynomial.chebyshev.chebval(x, coefficients)
        slopes[:, here] = np.polynomial.chebyshev.chebval(
            x, np.polynomial.chebyshev.chebder(coefficients)
        ) * (2 / width)
    return values, slopes


def _of_kind(kind: type[ForceLaw], scaled: Scaled) -> tuple[np.ndarray, np.ndarray]:
    """t_c, r, σ and D of impacts of laws of one kind, and their derivatives with respect to ln v,
    shape (4, m).
    """
    group = scaled.group
    values = np.empty((4, group.size))
    slopes = np.zeros((4, group.size))
    # Without dissipation, or if r is the same at every speed, the group is.
    same = (group == 0) | (scaled.group_exponent == 0)
    if same.any():
        groups, which = np.unique(group[same], return_inverse=True)
        values[:, same] = _of_groups(kind, tuple(groups.tolist()))[:, which]
    if not same.all():
        width = scaled.group_exponent * _WIDTH
        values[:, ~same], slopes[:, ~same] = _interpolated(kind, group[~same], width)
    slopes *= scaled.group_exponent
    times = [0, 2, 3]
    slopes[times] += scaled.time_exponent * values[times]
    values[times] *= scaled.time
    slopes[times] *= scaled.time
    return values, slopes


@dataclass(frozen=True, repr=False)
class Signature(Batch):
    """The signature of a contact law as a function of the impact speed.

    It is interpolated unless the law has a closed form.

    Parameters
    ----------
    law : ForceLaw
        A single law, unless its signature has a closed form or is that of all laws of its kind.

    Raises
    ------
    ModelError
        If the law does not release the ball, or has arrays of parameters, no closed form, and no
        :meth:`~.ForceLaw.scaled`.

    Examples
    --------
    The force of an elastic contact is symmetric in time, so that its centroid is in the middle and
    the effects of the load cancel:

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> instant = Signature(SpringDamper(2.0, 0.0))()
    >>> float(instant.delay) == np.pi / 4, float(instant.restitution), float(instant.load)
    (True, 1.0, 0.0)

    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping
    >>> instant = Signature(Tsuji(50.0, tsuji_damping(0.7)))([1.0, 2.0, 3.0])
    >>> instant.restitution.round(12).tolist()
    [0.7, 0.7, 0.7]
    """

    law: ForceLaw

    def __post_init__(self):
        if not self.is_constant and self.law.shape and self.law.scaled(np.ones(1)) is None:
            raise ModelError("the signature of a contact law is tabulated for one law, not many")

    @cached_property
    def _known(self) -> Instant | None:
        # Cached, because a simulation needs it at every impact.
        return self.law.constant_signature

    @property
    def is_constant(self) -> bool:
        """Whether the signature is the same at every impact speed, as for a linear contact."""
        return self._known is not None

    @property
    def label(self) -> str:
        """The name and the parameters of the law as text."""
        return self.law.label

    def __call__(self, speed: ArrayLike = 1.0) -> Instant:
        """The signature at speeds v > 0 of the continued flight at the instant.

        Its fields have the shape to which the speeds and the law broadcast.

        Raises
        ------
        ModelError
            If an impact at one of the speeds, or near it, does not end.
        """
        found = self.where_known(speed)
        if self.is_constant:
            return found
        v = np.broadcast_to(np.asarray(speed, dtype=float), np.shape(found.delay))
        lost = np.isnan(found.delay) & ~np.isnan(v)
        if lost.any():
            raise _unending(self.law.name, v[lost][0])
        return found

    def where_known(self, speed: ArrayLike) -> Instant:
        """The signature at the speeds at which impacts end, NaN at others.

        Newton's method for orbits tries speeds that no ball has.
        """
        v = np.asarray(speed, dtype=float)
        if self._known is not None:
            return self._known.at(v)
        shape = np.broadcast_shapes(v.shape, self.law.shape)
        row = np.clip(np.broadcast_to(v, shape).ravel(), _SLOWEST, _FASTEST)
        values = np.full((2, 4, row.size), np.nan)
        known = np.flatnonzero(~np.isnan(row))
        law = self.law.flat(shape).take(known)
        scaled = law.scaled(row[known])
        if scaled is None:
            values[:, :, known] = _interpolated(law, row[known], _width(law))
        else:
            values[:, :, known] = _of_kind(type(law), scaled)
        values[1] /= row
        values = values.reshape(2, 4, *shape)
        delay, restitution, load, duration = values[0]
        d_delay, d_restitution, d_load, d_duration = values[1]
        return Instant(
            delay=delay,
            restitution=restitution,
            load=load,
            duration=duration,
            d_delay=d_delay,
            d_restitution=d_restitution,
            d_load=d_load,
            d_duration=d_duration,
        )
