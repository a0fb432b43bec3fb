r"""The n-T branch of the spring-damper model as an explicit curve.

The paper solves its six equations (Eqs. 21-26) by numerical continuation.
At a fixed contact duration D they are *linear* in ::

    X = Λ cos φ,    Y = Λ sin φ,    u = δ′ at impact

With T = 2πn - D the flight time, and g, G, h the responses of the contact at
time D (see :mod:`bouncing_ball.models.contact`), they read

* release (Eq. 23): ``u g + X Im h + Y Re h = G``, or the same combination of
  the contact force for the force release;
* velocity (Eqs. 24, 26, 20): ``δ′_b + Λ cos(φ + D) = u + X + T``, where
  ``δ′_b = u g′ + X Im h′ + Y Re h′ - g``;
* landing (Eqs. 25, 19): ``δ_b + Λ sin(φ + D) + (u + X + T) T - T²/2 = Y``.

One 3×3 solve gives the orbit, so D runs along the whole branch: saddle-node
and period doubling included, ``Λ = √(X² + Y²)``, ``φ = atan2(Y, X)``.

For a stiff contact the branch occupies a range of D of order 1/ϖ² around the
free half period, where D itself has too few digits left. The curve is
therefore parametrised by the *excess angle* ε, ``ϖ_d D = θ₀ + ε``, with θ₀ the
angle at which the free contact would be released: π for the displacement
release, π - 2 arcsin ζ for the force release. The one coefficient that is
sensitive, that of u in the release condition, is then proportional to sin ε.

All quantities are dimensionless; all functions broadcast.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.models.contact import Contact, Release, responses


class BranchPoint(NamedTuple):
    """A point of the branch and its derivatives along ε.

    ``x``, ``y``, ``u`` are Λ cos φ, Λ sin φ and the relative impact velocity;
    ``duration`` is D; ``d_x``, ``d_y`` the derivatives dX/dε and dY/dε.
    """

    duration: np.ndarray
    x: np.ndarray
    y: np.ndarray
    u: np.ndarray
    d_x: np.ndarray
    d_y: np.ndarray

    @property
    def amplitude(self) -> np.ndarray:
        """Λ."""
        return np.hypot(self.x, self.y)

    @property
    def phase(self) -> np.ndarray:
        """φ in (-π, π]."""
        return np.arctan2(self.y, self.x)

    @property
    def fold(self) -> np.ndarray:
        """½ d(Λ²)/dε = X dX/dε + Y dY/dε, zero at the saddle-node."""
        return self.x * self.d_x + self.y * self.d_y


def _cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def _dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _combination(planes, determinant, right):
    return tuple(
        sum(b * plane[i] for b, plane in zip(right, planes, strict=True)) / determinant
        for i in range(3)
    )


def free_release_angle(contact: Contact) -> np.ndarray:
    """θ₀ = ϖ_d D at which the free contact, unforced and weightless, ends.

    Examples
    --------
    >>> float(free_release_angle(Contact(10.0, 0.5))) == np.pi
    True
    """
    zeta = np.asarray(contact.damping_ratio, dtype=float)
    if contact.release is Release.FORCE:
        return np.pi - 2 * np.arcsin(zeta)
    return np.full_like(zeta, np.pi)


def branch_point(excess: ArrayLike, contact: Contact, n: ArrayLike) -> BranchPoint:
    """The n-T orbit whose contact lasts ``D = (θ₀ + ε)/ϖ_d``.

    Parameters
    ----------
    excess : array_like
        ε, in radians of the contact's own oscillation.
    contact : Contact
        ϖ, ζ < 1 and the release rule.
    n : array_like of int
        Index of the family.

    Raises
    ------
    ModelError
        If ζ ≥ 1: an overdamped contact has no oscillation to count from.

    Examples
    --------
    A stiff elastic contact lasts exactly half a free period when the table's
    acceleration balances gravity, Λ sin φ = 1:

    >>> point = branch_point(0.0, Contact(1e6, 0.0), 1)
    >>> bool(abs(point.y - 1) < 1e-5), bool(abs(point.u + np.pi) < 1e-5)
    (True, True)
    """
    zeta = np.asarray(contact.damping_ratio, dtype=float)
    if not np.all(zeta < 1):
        raise ModelError(f"damping ratio ζ = {contact.damping_ratio} is not below 1")
    omega = np.asarray(contact.frequency_ratio, dtype=float)
    eps = np.asarray(excess, dtype=float)
    root = np.sqrt((1 - zeta) * (1 + zeta))
    duration = (free_release_angle(contact) + eps) / (omega * root)
    flight = 2 * np.pi * np.asarray(n) - duration
    a, q = zeta * omega, omega * omega

    g, G, h = responses(duration, omega, zeta)
    accelerations = -2 * a * g.rate - q * g.value, g.rate, 1j * h.rate + g.rate
    decay = np.exp(-a * duration) / root
    push = -decay * np.sin(eps)
    d_push = decay * (a * np.sin(eps) - omega * root * np.cos(eps))
    if contact.release is Release.FORCE:

        def released(value, rate):
            return 2 * zeta * rate + omega * value

        lift = 1.0
    else:

        def released(value, rate):
            return omega * value

        lift = 0.0  # the ball leaves from the table's level exactly
    table = released(h.value, h.rate)
    d_table = released(h.rate, accelerations[2])
    weight = released(G.value, G.rate)
    d_weight = released(G.rate, accelerations[1])
    sin_d, cos_d = np.sin(duration), np.cos(duration)
    versine = -2 * np.sin(duration / 2) ** 2  # cos D - 1

    # Unknowns (u, X, Y). Rows: release, velocity, landing.
    rows = (
        (push, table.imag, table.real),
        (g.rate - 1, h.rate.imag + versine, h.rate.real - sin_d),
        (
            flight + lift * g.value,
            flight + sin_d + lift * h.value.imag,
            versine + lift * h.value.real,
        ),
    )
    right = (weight, g.value + flight, lift * G.value - flight * flight / 2)
    d_rows = (
        (d_push, d_table.imag, d_table.real),
        (accelerations[0], accelerations[2].imag - sin_d, accelerations[2].real - cos_d),
        (
            lift * g.rate - 1,
            cos_d - 1 + lift * h.rate.imag,
            -sin_d + lift * h.rate.real,
        ),
    )
    d_right = (d_weight, g.rate - 1, lift * G.rate + flight)

    planes = _cross(rows[1], rows[2]), _cross(rows[2], rows[0]), _cross(rows[0], rows[1])
    determinant = _dot(rows[0], planes[0])
    solution = _combination(planes, determinant, right)
    change = tuple(db - _dot(row, solution) for db, row in zip(d_right, d_rows, strict=True))
    _, d_x, d_y = _combination(planes, determinant, change)
    u, x, y = solution
    per_angle = 1 / (omega * root)
    return BranchPoint(duration, x, y, u, d_x * per_angle, d_y * per_angle)
