r"""When the ball never leaves the table (Eq. 9 and Eqs. 28-36).

A ball without contact stiffness stays down for Λ ≤ Λ_CR = 1. A ball on a
spring-damper oscillates steadily, and with the displacement release it stays
down while its displacement relative to the table never becomes positive::

    Λ ≤ Λ_SD(ϖ) = √γ/ϖ² = √((1 - x)² + 4ζ² x),     x = 1/ϖ²       (Eq. 33)

With the force release it stays down while the table always pushes. The force
over the weight is 1 + z″, and the table's motion reaches the ball with the
transmissibility (1 + 2iζ√x)/(1 - x + 2iζ√x), so that ::

    Λ ≤ Λ_F(ϖ) = √[((1 - x)² + 4ζ² x)/(1 + 4ζ² x)]

For any other law there is no closed form. At the threshold the steady contact just
touches its release once in a period. It is then a contact of duration 2π that starts and
ends in the same state (p₀, p′₀), at which the grip g vanishes together with its rate of change::

    p″ = 1 - Λ sin(φ + t) - f(p, p′),   (p, p′)(0) = (p, p′)(2π)
    g(p₀, p′₀) = 0,   ∂g/∂p p′₀ + ∂g/∂p′ (1 - Λ sin φ - f) = 0

with φ and Λ unknown too; for a release at p = 0 the last two are p₀ = p′₀ = 0. Next to the
touch p goes as t². In x with t = 2π S(x) and S′ ∝ [x (1 - x)]^{m-1}, m half the roots of the
law, the contact is smooth.

All quantities are dimensionless.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw, check_damping, check_positive, slopes_of
from bouncing_ball.contacts.contact_scales import depth
from bouncing_ball.contacts.release import Release
from bouncing_ball.errors import ModelError, require

_PERIOD = 2 * np.pi
# Residual over the right side: the threshold's relative error is a tenth of it or less. And nodes:
# more would follow the oscillations of a contact that rings.
_TOLERANCE, _FIRST, _NODES = 1e-8, 129, 50_000
_TINY = 1e-300

RESTITUTION_THRESHOLD = 1.0
"""Λ_CR: the table's acceleration reaches that of gravity (Eq. 9)."""


class Minimum(NamedTuple):
    """Lowest threshold over all frequency ratios, and where it is reached."""

    threshold: np.ndarray
    frequency_ratio: np.ndarray


def permanent_contact_threshold(
    frequency_ratio: ArrayLike, damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> np.ndarray:
    """Largest Λ of permanent contact, Λ_SD(ϖ) (Eq. 33) or Λ_F(ϖ).

    Raises
    ------
    ModelError
        If ϖ ≤ 0 or ζ < 0.

    Examples
    --------
    >>> float(permanent_contact_threshold(1.0, 0.25))
    0.5
    """
    check_positive(frequency_ratio, "frequency ratio ϖ")
    check_damping(damping_ratio, "damping ratio ζ")
    omega = np.asarray(frequency_ratio, dtype=float)
    loss = 2 * np.asarray(damping_ratio) / omega
    lag = 2 * Release.of(release).sine(damping_ratio) / omega
    return np.hypot((1 - 1 / omega) * (1 + 1 / omega), loss) / np.hypot(1, lag)


def permanent_contact_minimum(
    damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> Minimum:
    """Lowest threshold over ϖ: its derivative along x vanishes at ::

        x = 2m/(1 + √(1 + 8 sin²α m)),     m = 1 - 2ζ² + 2 sin²α

    For the displacement release 2ζ√(1 - ζ²) at ϖ = 1/√(1 - 2ζ²) (Eq. 36).

    Raises
    ------
    ModelError
        If ζ ≥ 1/√2 with the displacement release: Λ_SD then falls towards 1
        for all ϖ and has no minimum.

    Examples
    --------
    >>> round(float(permanent_contact_minimum(0.6).threshold), 15)
    0.96
    """
    zeta, sine = np.asarray(damping_ratio, dtype=float), Release.of(release).sine(damping_ratio)
    centre = 1 - 2 * (zeta - sine) * (zeta + sine)
    allowed = "in [0, 1/√2): the permanent-contact threshold has no minimum over ϖ there"
    require((zeta >= 0) & (centre > 0), zeta, "damping ratio ζ", allowed)
    x = 2 * centre / (1 + np.sqrt(1 + 8 * sine * sine * centre))
    omega = 1 / np.sqrt(x)
    return Minimum(permanent_contact_threshold(omega, zeta, release), omega)


def permanent_contact(law: ContactLaw) -> float:
    """The threshold of one law.

    Raises
    ------
    ModelError
        If no steady contact was found that touches its release once.

    Examples
    --------
    Λ_SD = √13/4 for ϖ = 2 and ζ = 1/2:

    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> round(permanent_contact(SpringDamper(2.0, 0.5)) / 13**0.5, 9)
    0.25
    """
    from scipy.integrate import solve_bvp
    from scipy.special import beta, betainc

    roots = max(1, law.root // 2)

    def change(time, state, unknown):
        """p″, where p may be a little off the table."""
        (depth, rate), (phase, amplitude) = state, unknown
        return 1 - amplitude * np.sin(phase + time) - law.force(np.maximum(depth, _TINY), rate)

    def rates(x, state, unknown):
        pace = np.stack([state[1], change(_PERIOD * betainc(roots, roots, x), state, unknown)])
        return _PERIOD / beta(roots, roots) * (x * (1 - x)) ** (roots - 1) * pace

    def touch(start, end, unknown):
        if law.release is Release.DISPLACEMENT:
            return np.concatenate([start, end])
        by = slopes_of(law.grip, np.maximum(start[0], _TINY), start[1])
        turns = by.by_penetration * start[1] + by.by_rate * change(0.0, start, unknown)
        return np.array([*(end - start), law.grip(*start), turns])

    # The contact that follows its load slowly.
    x = np.linspace(0, 1, _FIRST)
    time, unknown = _PERIOD * betainc(roots, roots, x), [np.pi / 2, 1.0]
    path = depth(law, 0 * x, 0.0, np.maximum(1 - np.cos(time), 1e-9))
    guess = np.stack([path, np.gradient(path, time)])
    with np.errstate(all="ignore"):
        found = solve_bvp(rates, touch, x, guess, unknown, tol=_TOLERANCE, max_nodes=_NODES)
        inside = found.y[:, 1:-1]
        held = np.all(inside[0] > 0) and np.all(law.grip(*inside) > 0)
    if not (found.success and held and found.p[1] > 0):
        raise ModelError(
            f"no steady contact that just touches its release was found for {law.label}: "
            "weakly damped, it rings"
        )
    return float(found.p[1])
