r"""What is left of a contact law outside the contact: the signature of an impact.

In the table's frame the ball obeys δ″ = -a + F, with the load ``a = 1 - Λ sin τ``
and F the contact force over the mass. Continue the free flights before and
after the contact into it. Both fall with the same a, so that their distance
grows as the impulse of F has come in, whatever the table does meanwhile::

    δ_out(t) - δ_in(t) = ∫ F(s) (t - s) ds = J (t - t_c),    J = ∫ F ds

They meet at one instant, the centroid of the force, ``t_c = ∫ s F ds / J``: to
the outside a contact *is* an instantaneous impact at that moment, below the
table's level, with the restitution ``r_c = -δ′_out/δ′_in`` of the continued
flights. This much is exact. A contact law enters by functions of the impact
speed v alone, to second order in the contact duration:

* the *delay* t_c(v), from the start of contact to the instant;
* the *restitution* r(v) of the free impact, without load;
* the *load sensitivity* σ(v), ``r_c = r + σ a/v``, v and a at the instant;
* the *duration* D(v) of the contact, which says only when the ball leaves.

For the linear contact they are constants. It ends where δ + κ δ′ = 0, with
κ = 0 for the displacement release and κ = 2ζ/ϖ for the force release, at the
angle ``ϖ_d D = π - 2 arcsin(κϖ/2)``. The free impact ends with δ′ = r v and
δ = -κ r v, hence from F = δ″ and one integration by parts ::

    t_c = (D δ′_b - δ_b)/((1 + r) v) = r (D + κ)/(1 + r)

A constant load adds -a G to δ, with ``G = (1 - g′ - 2ζϖ g)/ϖ²`` and g the
impulse response. The release is then later by ``(1 + r) a/(r v ϖ²)``, and the
velocity there changes to first order by ``-[2ζ(1 + r)/ϖ - κ] a``; the ends of
contact and the instant are D apart in all, which adds ``[D - (1 + r) t_c] a``::

    σ = (1 - r)(D + κ) - 2ζ (1 + r)/ϖ

All quantities are dimensionless; all functions broadcast.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.impacts.damping import restitution_coefficient
from bouncing_ball.impacts.release import Release
from bouncing_ball.impacts.spring_damper import Contact


class Instant(NamedTuple):
    """The signature at an impact speed v, and the derivatives along v.

    ``delay`` t_c, ``restitution`` r, ``load`` σ and ``duration`` D; t_c, σ and D
    are times, r is a number.
    """

    delay: np.ndarray
    restitution: np.ndarray
    load: np.ndarray
    duration: np.ndarray
    d_delay: np.ndarray | float = 0.0
    d_restitution: np.ndarray | float = 0.0
    d_load: np.ndarray | float = 0.0


class Signature(Protocol):
    """A contact law, seen from outside."""

    @property
    def is_constant(self) -> bool:
        """Whether the impact speed changes nothing, as for a linear contact."""
        ...

    def __call__(self, speed: ArrayLike) -> Instant:
        """The signature of impacts at speeds v > 0."""
        ...

    def flat(self, shape: tuple[int, ...]) -> "Signature":
        """The laws of balls in an array of a shape, as a flat array."""
        ...

    def take(self, which: np.ndarray | slice) -> "Signature":
        """The laws of some balls of a flat array."""
        ...


@dataclass(frozen=True)
class LinearSignature:
    """Signature of the spring-damper contact, in closed form.

    Parameters
    ----------
    contact : Contact
        ϖ, ζ < 1 and the release rule.

    Raises
    ------
    ModelError
        If ζ ≥ 1: a free overdamped contact never ends.

    Examples
    --------
    An elastic contact pushes symmetrically, and its load cancels:

    >>> instant = LinearSignature(Contact(2.0, 0.0))(1.0)
    >>> float(instant.delay) == np.pi / 4, float(instant.restitution), float(instant.load)
    (True, 1.0, 0.0)
    """

    contact: Contact

    def __post_init__(self):
        zeta = np.asarray(self.contact.damping_ratio, dtype=float)
        require(zeta < 1, zeta, "damping ratio ζ", "below 1")

    @property
    def is_constant(self) -> bool:
        """A linear impact is the same at every speed."""
        return True

    def flat(self, shape: tuple[int, ...]) -> "LinearSignature":
        """One contact for each ball; a contact that is the same for all stays one."""
        return self._each(lambda x: np.broadcast_to(x, shape).ravel() if np.ndim(x) else x)

    def take(self, which: np.ndarray | slice) -> "LinearSignature":
        """The contacts of some balls."""
        return self._each(lambda x: np.asarray(x)[which] if np.ndim(x) else x)

    def _each(self, change: Callable) -> "LinearSignature":
        contact = self.contact
        parts = change(contact.frequency_ratio), change(contact.damping_ratio)
        return LinearSignature(Contact(*parts, contact.release))

    def __call__(self, speed: ArrayLike = 1.0) -> Instant:
        """The signature; the speed only gives the shape."""
        contact = self.contact
        omega, zeta, _ = np.broadcast_arrays(
            contact.frequency_ratio, contact.damping_ratio, np.asarray(speed, dtype=float)
        )
        r = restitution_coefficient(zeta, contact.release)
        force = contact.release is Release.FORCE
        lag = 2 * zeta / omega if force else np.zeros_like(r)
        angle = np.pi - 2 * np.arcsin(lag * omega / 2)
        duration = angle / (omega * np.sqrt((1 - zeta) * (1 + zeta)))
        # When the flight after the contact, continued, rises through δ = 0.
        through = duration + lag
        return Instant(
            delay=r * through / (1 + r),
            restitution=r,
            load=(1 - r) * through - 2 * zeta * (1 + r) / omega,
            duration=duration,
        )
