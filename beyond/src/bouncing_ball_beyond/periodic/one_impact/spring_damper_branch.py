r"""The n-T branch of the spring-damper model as an explicit curve.

The paper solves its six equations (Eqs. 21-26) by numerical continuation.
At a fixed contact duration D they are *linear* in ::

    X = Λ cos φ,    Y = Λ sin φ,    u = δ′ at impact

Let T = 2πn - D be the flight time, and g, G, h the responses of the contact at
time D (see :mod:`bouncing_ball_beyond.models.oscillator`). The equations are then

* release (Eq. 23): ``δ_b + κ δ′_b = 0``, that is ``u g + X Im h + Y Re h = G``
  for the displacement release, κ = 0;
* velocity (Eqs. 24, 26, 20): ``δ′_b + Λ cos(φ + D) = u + X + T``, where
  ``δ′_b = u g′ + X Im h′ + Y Re h′ - g``;
* landing (Eqs. 25, 19): ``δ_b + Λ sin(φ + D) + (u + X + T) T - T²/2 = Y``
  with ``δ_b = -κ δ′_b``.

The solution of this 3×3 system is the orbit. D is therefore a parameter of the entire branch,
saddle-node and period doubling included, with ``Λ = √(X² + Y²)`` and ``φ = atan2(Y, X)``.

For a stiff contact the branch occupies a range of D of order 1/ϖ² around the free half
period, and a double has too few digits of D to distinguish its points. The curve is
therefore parametrised by the *excess angle* ε, ``ϖ_d D = θ₀ + ε``, where θ₀ is the
angle at which the free contact would be released, π - 2α with sin α = κϖ/2
(:mod:`bouncing_ball_beyond.models.damping`). The one sensitive coefficient,
that of u in the release condition, is then proportional to sin ε.

Differentiating the three equations along ε gives dΛ/dε. It vanishes at the
saddle-node, and also where the ball grazes at impact or release, where no
multiplier is 1. The determinant of the monodromy M is ``exp(-2ζϖD)``, because the
contact contracts the volume of (τ, δ, δ′) at the rate 2ζϖ and the flight preserves it.
Its trace follows from ``det(M - 1) = 1 - tr + det``, which is the Jacobian
determinant of velocity and landing in (φ, u), divided by u. With A the matrix of the
three equations and R_D the derivative of the first one along D at fixed (X, Y, u), ::

    1 - tr + det = -(det A / (u R_D)) ½ d(Λ²)/dD

All quantities are dimensionless; all functions broadcast.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import require
from bouncing_ball_beyond.inherited.models.damping import damped_frequency
from bouncing_ball_beyond.inherited.numerics.arrays import blocks, pick
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.oscillator import gravity_response, table_response
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

# Number of points computed at the same time, so that the intermediate arrays stay in the cache.
_BLOCK = 8192


class BranchPoint(NamedTuple):
    """Points of the branch, their derivatives along ε, and their stability; arrays of one shape.

    ``x``, ``y``, ``u`` are Λ cos φ, Λ sin φ and the relative impact velocity;
    ``contact_duration`` is D; ``d_x``, ``d_y`` are the derivatives dX/dε and dY/dε;
    ``determinant`` is that of the monodromy and ``saddle_node`` its ``1 - tr + det``.
    """

    contact_duration: np.ndarray
    x: np.ndarray
    y: np.ndarray
    u: np.ndarray
    d_x: np.ndarray
    d_y: np.ndarray
    saddle_node: np.ndarray
    determinant: np.ndarray

    @property
    def trace(self) -> np.ndarray:
        """Trace of the monodromy, from its determinant and 1 - tr + det."""
        return 1 + self.determinant - self.saddle_node

    @property
    def amplitude(self) -> np.ndarray:
        """Λ = √(X² + Y²)."""
        return np.sqrt(self.x * self.x + self.y * self.y)

    @property
    def phase(self) -> np.ndarray:
        """φ = atan2(Y, X), in (-π, π]."""
        return np.arctan2(self.y, self.x)

    @property
    def fold(self) -> np.ndarray:
        """½ d(Λ²)/dε = X dX/dε + Y dY/dε = Λ dΛ/dε, which is zero at the saddle-node."""
        return self.x * self.d_x + self.y * self.d_y


class _ContactEnd(NamedTuple):
    """The contact at its end, at the time D: its responses and their derivatives.

    ``g``, ``gravity`` and ``q``, ``p`` are g, G, Q = Re h and P = Im h at D, and d… and dd… the
    first and second derivatives. ``push`` is ϖ (g + κ g′), the coefficient of u in the release
    condition, and ``d_push`` its derivative. The table turns by the angle D in contact;
    ``cos_less_one`` is cos D - 1. ``decay`` is e^{-ζϖD}.
    """

    g: np.ndarray
    dg: np.ndarray
    ddg: np.ndarray
    gravity: np.ndarray
    q: np.ndarray
    dq: np.ndarray
    ddq: np.ndarray
    p: np.ndarray
    ddp: np.ndarray
    push: np.ndarray
    d_push: np.ndarray
    sin_d: np.ndarray
    cos_d: np.ndarray
    cos_less_one: np.ndarray
    decay: np.ndarray

    @classmethod
    def of(cls, eps, duration, omega, zeta, sine, root) -> "_ContactEnd":
        """The contact with the excess angle ε and D; ``root`` is √(1 - ζ²)."""
        loss = 2 * zeta * omega
        stiffness = omega * omega
        sin_eps = np.sin(eps)
        cos_eps = np.cos(eps)
        # ϖ_d D = θ₀ + ε with θ₀ = π - 2α, where the sine and cosine of 2α are exact.
        sin_2a = 2 * sine * np.sqrt((1 - sine) * (1 + sine))
        cos_2a = 1 - 2 * sine * sine
        sin_angle = sin_2a * cos_eps - cos_2a * sin_eps
        cos_angle = -cos_2a * cos_eps - sin_2a * sin_eps
        sin_half = np.sin(duration / 2)
        cos_half = np.cos(duration / 2)
        sin_d = 2 * sin_half * cos_half
        cos_less_one = -2 * sin_half * sin_half
        cos_d = 1 + cos_less_one
        decay = np.exp(-zeta * omega * duration)
        g = decay * sin_angle / (omega * root)
        dg = decay * (cos_angle - zeta / root * sin_angle)
        rest = dg + loss * g
        contact = duration, omega, zeta
        gravity = gravity_response(*contact, 1 - rest)
        q, p = table_response(*contact, cos_d - rest, sin_d - g)
        # From the oscillator's equation, and from h′ = i h + g, so that P′ = Q and Q′ = g - P.
        ddg = -loss * dg - stiffness * g
        dq = g - p
        return cls(
            g=g,
            dg=dg,
            ddg=ddg,
            gravity=gravity,
            q=q,
            dq=dq,
            ddq=dg - q,
            p=p,
            ddp=dq,
            push=-decay / root * sin_eps,
            d_push=decay / root * (zeta * omega * sin_eps - omega * root * cos_eps),
            sin_d=sin_d,
            cos_d=cos_d,
            cos_less_one=cos_less_one,
            decay=decay,
        )


class _Equation(NamedTuple):
    """A linear equation for (u, X, Y): coefficients and right side, and their derivatives by D."""

    row: tuple[Any, Any, Any]
    right: Any
    d_row: tuple[Any, Any, Any]
    d_right: Any

    def change(self, u, x, y):
        """The right side of the equation for the derivatives of (u, X, Y) by D."""
        return self.d_right - (self.d_row[0] * u + self.d_row[1] * x + self.d_row[2] * y)


def _equations(end: _ContactEnd, flight, omega, sine) -> tuple[_Equation, _Equation, _Equation]:
    """The three equations of an orbit: release, velocity and landing."""
    twice = 2 * sine
    lag = 2 * sine / omega
    # ϖ (δ_b + κ δ′_b) = 0
    release = _Equation(
        row=(end.push, omega * end.p + twice * end.q, omega * end.q + twice * end.dq),
        right=omega * end.gravity + twice * end.g,
        d_row=(end.d_push, omega * end.q + twice * end.ddp, omega * end.dq + twice * end.ddq),
        d_right=omega * end.g + twice * end.dg,
    )
    velocity = _Equation(
        row=(end.dg - 1, end.q + end.cos_less_one, end.dq - end.sin_d),
        right=end.g + flight,
        d_row=(end.ddg, end.ddp - end.sin_d, end.ddq - end.cos_d),
        d_right=end.dg - 1,
    )
    # δ_b = -κ δ′_b, which is exactly 0 for the displacement release.
    landing = _Equation(
        row=(
            flight - lag * end.dg,
            flight + end.sin_d - lag * end.q,
            end.cos_less_one - lag * end.dq,
        ),
        right=-flight * flight / 2 - lag * end.g,
        d_row=(-1 - lag * end.ddg, end.cos_less_one - lag * end.ddp, -end.sin_d - lag * end.ddq),
        d_right=flight - lag * end.dg,
    )
    return release, velocity, landing


def _cramer(rows):
    """A solver of 3×3 systems with these rows by Cramer's rule, and their determinants."""
    (a1, a2, a3), (b1, b2, b3), (c1, c2, c3) = rows
    bc = b2 * c3 - b3 * c2, b3 * c1 - b1 * c3, b1 * c2 - b2 * c1
    ca = c2 * a3 - c3 * a2, c3 * a1 - c1 * a3, c1 * a2 - c2 * a1
    ab = a2 * b3 - a3 * b2, a3 * b1 - a1 * b3, a1 * b2 - a2 * b1
    determinant = a1 * bc[0] + a2 * bc[1] + a3 * bc[2]
    # The determinant is zero at a pole of the branch, where Λ is infinite and there is no orbit.
    if np.any(determinant == 0):
        determinant = np.where(determinant == 0, np.nan, determinant)
    inverse = 1 / determinant

    def solve(s, t, v):
        return tuple((s * bc[k] + t * ca[k] + v * ab[k]) * inverse for k in range(3))

    return solve, determinant


def branch_point(excess: ArrayLike, contact: SpringDamper, n: ArrayLike) -> BranchPoint:
    """The points of the inherited
    :func:`bouncing_ball_beyond.inherited.periodic.spring_damper_branch.branch_point`, the solutions
    of Eqs. 23-26, with their derivatives along ε.

    Returns
    -------
    BranchPoint
        Arrays of the shape to which the arguments broadcast.

    Raises
    ------
    ModelError
        If ζ ≥ 1: an overdamped contact does not oscillate, so that ε is not defined.

    Examples
    --------
    A stiff elastic contact lasts exactly half a free period when the table's
    acceleration balances gravity, Λ sin φ = 1:

    >>> point = branch_point(0.0, SpringDamper(1e6, 0.0), 1)
    >>> bool(abs(point.y - 1) < 1e-5), bool(abs(point.u + np.pi) < 1e-5)
    (True, True)
    """
    arguments = [
        np.asarray(x, dtype=float)
        for x in (excess, contact.frequency_ratio, contact.damping_ratio, contact.release_sine, n)
    ]
    zeta = arguments[2]
    if not (zeta < 1).all():
        require(zeta < 1, zeta, "damping ratio ζ", "below 1")
    shape = np.broadcast_shapes(*(x.shape for x in arguments))
    size = math.prod(shape)
    if size <= _BLOCK:
        return _branch_point(*arguments)
    # Scalars stay scalars; arrays are computed in blocks.
    flat = [x if x.ndim == 0 else np.broadcast_to(x, shape).ravel() for x in arguments]
    parts = [_branch_point(*(pick(x, part) for x in flat)) for part in blocks(size, _BLOCK)]
    return BranchPoint(*(np.concatenate(x).reshape(shape) for x in zip(*parts, strict=True)))


# What a long contact leaves may be below the smallest number, and is then 0, whatever the caller
# lets numpy do.
@np.errstate(under="ignore")
def _branch_point(eps, omega, zeta, sine, n) -> BranchPoint:
    """:func:`branch_point` for one block of arrays; ``sine`` is sin α = κϖ/2."""
    root = damped_frequency(zeta)
    per_angle = 1 / (omega * root)
    duration = (2 * np.arccos(sine) + eps) * per_angle
    flight = 2 * np.pi * n - duration
    end = _ContactEnd.of(eps, duration, omega, zeta, sine, root)
    equations = _equations(end, flight, omega, sine)
    solve, determinant = _cramer([equation.row for equation in equations])
    u, x, y = solve(*(equation.right for equation in equations))
    changes = [equation.change(u, x, y) for equation in equations]
    _, d_x, d_y = solve(*changes)
    # Infinite or not a number where the ball grazes at impact or at release.
    with np.errstate(divide="ignore", invalid="ignore"):
        saddle_node = determinant * (x * d_x + y * d_y) / (u * changes[0])
    # The duration and the decay may have fewer axes than the other fields.
    none = 0 * u
    return BranchPoint(
        contact_duration=duration + none,
        x=x,
        y=y,
        u=u,
        d_x=d_x * per_angle,
        d_y=d_y * per_angle,
        saddle_node=saddle_node,
        determinant=end.decay * end.decay + none,
    )


def orbits_of_points(point: BranchPoint, contact: SpringDamper, n: ArrayLike) -> Orbit:
    """The orbits at points of the branch."""
    return Orbit.of(
        ContactModel(contact),
        n,
        point.amplitude,
        point.phase,
        point.contact_duration,
        point.u + point.x,
    )


def excess_angle(contact: SpringDamper, duration: ArrayLike) -> np.ndarray:
    """ε of contacts that last for the time D: the inverse of ``D = (θ₀ + ε)/ϖ_d``.

    Examples
    --------
    >>> contact = SpringDamper(5.0, 0.1)
    >>> point = branch_point(0.25, contact, 1)
    >>> round(float(excess_angle(contact, point.contact_duration)), 12)
    0.25
    """
    zeta = contact.damping_ratio
    root = damped_frequency(zeta)
    free = 2 * np.arccos(contact.release_sine)
    return np.asarray(duration) * contact.frequency_ratio * root - free


def orbits_on_branch(excess: ArrayLike, contact: SpringDamper, n: ArrayLike) -> Orbit:
    """The orbits with excess angles ε of the contact; NaN where ε is NaN.

    Raises
    ------
    ModelError
        If ζ ≥ 1.

    Examples
    --------
    >>> float(orbits_on_branch(0.0, SpringDamper(5.0, 0.0), 1).trace_and_determinant()[1])
    1.0
    """
    return orbits_of_points(branch_point(excess, contact, n), contact, n)
