r"""Amplitudes at which the ball never leaves the table (Eq. 9 and Eqs. 28-36).

A ball on a rigid table never leaves it for Λ ≤ Λ_CR = 1. A ball on a
spring-damper oscillates steadily, and with the displacement release it never
leaves if its displacement relative to the table never becomes positive::

    Λ ≤ Λ_SD(ϖ) = √γ/ϖ² = √((1 - x)² + 4ζ² x),     x = 1/ϖ²       (Eq. 33)

With the force release it never leaves if the table pushes it at all times. The force
over the weight is 1 + z″, and the table's motion reaches the ball with the
transmissibility (1 + 2iζ√x)/(1 - x + 2iζ√x), so that ::

    Λ ≤ Λ_F(ϖ) = √[((1 - x)² + 4ζ² x)/(1 + 4ζ² x)]

Most other laws have no closed form. At the threshold the grip g vanishes exactly once per period
and does not change its sign. The steady motion is then a contact of duration 2π that starts and
ends in the same state (p₀, p′₀), where g and its rate of change are zero::

    B = 2π [1 - Λ sin(φ + 2π S) - f],   gain B = 0,   p′₀ + lift B = 0
    g(p₀, p′₀) = 0,   ∂g/∂p p′₀ + ∂g/∂p′ (1 - Λ sin φ - f) = 0

where φ and Λ are unknown too; for a release at p = 0 the last two equations are p₀ = p′₀ = 0. The
nodes are those of :mod:`bouncing_ball.contacts.quadrature`. Near this state p is proportional to
t², so that m/2 in place of m makes the motion smooth. Newton's method starts from a depth
proportional to 1 - cos t, as the load is for Λ = 1 and φ = π/2. The number of nodes is increased
until the last Legendre coefficients are small.

The motion under a law with a kink is not smooth at the kink. It is computed by the panels of
:mod:`bouncing_ball.contacts.collocation`, which end at kinks, over one period that starts and ends
half a period from the touch. If the force depends on the load, the ball may also touch the surface,
p = p′ = 0, before the grip vanishes; the lower of the two thresholds is the result.

All quantities are dimensionless.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.collocation import MOST_PANELS, Start, march
from bouncing_ball.contacts.contact_law import ContactLaw, slopes_of
from bouncing_ball.contacts.contact_scales import depth, rest
from bouncing_ball.contacts.quadrature import Scheme, scheme
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import permanent_contact_threshold
from bouncing_ball.errors import ModelError, require

_LEVELS = (48, 96, 128, 192, 256, 384)
_PERIOD = 2 * np.pi
_ITERATIONS = 25
# Step of φ and Λ at which the iteration ends, their longest step, and the largest ratio of the
# last Legendre coefficients to the largest one; the error of Λ is of the order of its square.
_SETTLED, _LONGEST, _SPECTRUM = 1e-11, 0.3, 1e-5
_TAIL = 3
_TINY = 1e-300


class Minimum(NamedTuple):
    """Lowest threshold over all frequency ratios, and the ϖ at which it is reached."""

    threshold: np.ndarray
    frequency_ratio: np.ndarray


def permanent_contact_minimum(
    damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> Minimum:
    """Lowest threshold over ϖ, where its derivative with respect to x = 1/ϖ² vanishes ::

        x = 2m/(1 + √(1 + 8 sin²α m)),     m = 1 - 2ζ² + 2 sin²α

    For the displacement release it is 2ζ√(1 - ζ²) at ϖ = 1/√(1 - 2ζ²) (Eq. 36).

    Raises
    ------
    ModelError
        If ζ < 0, or if ζ ≥ 1/√2 with the displacement release: Λ_SD then
        decreases towards 1 as ϖ grows, and has no minimum.

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


def _start(s: Scheme, law: ContactLaw) -> np.ndarray:
    """Unknowns (B, p₀, p′₀, φ, Λ) of a contact whose depth follows 1 - cos t."""
    one = np.ones(1)
    mean = depth(law, 0 * one, 0.0, one)[0]
    push = _PERIOD * mean * np.cos(_PERIOD * s.share)
    return np.concatenate([push, [0.0, 0.0, np.pi / 2, 1.0]])


def _touch(law: ContactLaw, unknowns: np.ndarray):
    """Residuals of the two conditions on the state in which the contact begins and ends.

    The second result are their rows of the Jacobian, with respect to (p₀, p′₀, φ, Λ).
    """
    p, u, phase, lam = unknowns
    if law.release is Release.DISPLACEMENT:
        return np.array([p, u]), np.eye(2, 4)
    inside = np.maximum(p, _TINY)
    by, force = slopes_of(law.grip, inside, u), slopes_of(law.force, inside, u)
    push = 1 - lam * np.sin(phase) - law.force(inside, u)
    value = np.array([law.grip(p, u), by.by_penetration * u + by.by_rate * push])
    # The second derivatives of the grip are neglected.
    pushed = force.by_penetration, force.by_rate, lam * np.cos(phase), np.sin(phase)
    turning = np.array([0.0, by.by_penetration, 0.0, 0.0]) - by.by_rate * np.array(pushed)
    return value, np.array([[by.by_penetration, by.by_rate, 0.0, 0.0], turning])


def _equations(s: Scheme, law: ContactLaw, z: np.ndarray):
    """Residual and Jacobian of all equations, and p and p′ at the nodes."""
    n = len(s.node)
    push, (p0, u0, phase, lam) = z[:n], z[n:]
    side = np.where(s.early, s.share, -s.rest)
    u = u0 + s.rate @ push
    depths = p0 + _PERIOD * (u0 * side + s.path @ push)
    p = np.maximum(depths, _TINY)
    by, angle = slopes_of(law.force, p, u), phase + _PERIOD * s.share
    residual, jacobian = np.empty(n + 4), np.zeros((n + 4, n + 4))
    residual[:n] = push - _PERIOD * (1 - lam * np.sin(angle) - law.force(p, u))
    deep = _PERIOD * by.by_penetration
    jacobian[:n, :n] = np.eye(n) + _PERIOD * (
        deep[:, np.newaxis] * s.path + by.by_rate[:, np.newaxis] * s.rate
    )
    jacobian[:n, n] = deep
    jacobian[:n, n + 1] = _PERIOD * (deep * side + by.by_rate)
    jacobian[:n, n + 2] = _PERIOD * lam * np.cos(angle)
    jacobian[:n, n + 3] = _PERIOD * np.sin(angle)
    residual[n], jacobian[n, :n] = s.gain @ push, s.gain
    residual[n + 1], jacobian[n + 1, :n] = u0 + s.lift @ push, s.lift
    jacobian[n + 1, n + 1] = 1
    residual[n + 2 :], jacobian[n + 2 :, n:] = _touch(law, z[n:])
    return residual, jacobian, depths, u


def _solved(s: Scheme, law: ContactLaw, z: np.ndarray, free: int = 0) -> np.ndarray | None:
    """The unknowns if Newton's method converges from z to a contact without release, else None.

    With ``free`` only the first of the unknowns are solved for, by the first of the equations.
    """
    free = free or z.size
    for _ in range(_ITERATIONS):
        residual, jacobian, depths, u = _equations(s, law, z)
        if not (np.all(np.isfinite(residual)) and np.all(np.isfinite(jacobian))):
            return None
        try:
            step = np.linalg.solve(jacobian[:free, :free], residual[:free])
        except np.linalg.LinAlgError:
            return None
        size = np.max(np.abs(step[-2:]))
        z = np.append(z[:free] - min(1.0, _LONGEST / max(size, _TINY)) * step, z[free:])
        if size <= _SETTLED:
            held = np.all(depths > 0) and np.all(law.grip(depths, u) > 0)
            return z if held else None
    return None


def _by_panels(law: ContactLaw, at_surface: bool) -> float:
    """Λ of the steady contact that touches the surface or just reaches its release, else NaN."""
    from scipy.optimize import root

    unit = rest(law)

    def motion(z: np.ndarray, times: ArrayLike):
        """p and p′ at times counted from half a period before the touch."""
        end = np.atleast_1d(times).astype(float)
        state = unit * z[0], unit * z[1], z[2] - _PERIOD / 2, z[3], 1.0
        found = march(law, Start(*(x + 0 * end for x in state)), MOST_PANELS, end)
        return found.penetration, found.rate

    def defects(z: np.ndarray) -> np.ndarray:
        (p, last), (u, last_rate) = motion(z, [_PERIOD / 2, _PERIOD])
        phase, lam = z[2:]
        load, small = 1 - lam * np.sin(phase), 1e-20j
        push = load - law.loaded_force(p, u, load)
        moved = p + small * u, u + small * push, load - small * lam * np.cos(phase)
        falls = np.imag(law.loaded_grip(*moved)) / small.imag
        touch = (p, u) if at_surface else (law.loaded_grip(p, u, load), falls)
        return np.array([*touch, last - unit * z[0], last_rate - unit * z[1]]) / unit

    found = root(defects, [2.0, 0.0, np.pi / 2, 1.0], tol=_SETTLED)
    times = np.linspace(0.0, _PERIOD, _LEVELS[0])
    p, u = motion(found.x, times)
    load = 1 - found.x[3] * np.sin(found.x[2] - _PERIOD / 2 + times)
    held = np.minimum(p, law.loaded_grip(p, u, load)) if law.feels_load else law.grip(p, u)
    solved = np.max(np.abs(found.fun)) < _SPECTRUM**2 and found.x[3] > 0
    return float(found.x[3]) if solved and np.min(held) > -_SPECTRUM * unit else np.nan


def permanent_contact(law: ContactLaw) -> float:
    """The largest Λ of permanent contact of a single law.

    Raises
    ------
    ModelError
        If no steady contact was found whose grip vanishes once per period.

    Examples
    --------
    Λ_SD = √13/4 for ϖ = 2 and ζ = 1/2:

    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> round(permanent_contact(SpringDamper(2.0, 0.5)) / 13**0.5, 12)
    0.25
    """
    if law.permanent_contact is not None:
        return float(law.permanent_contact)
    with np.errstate(all="ignore"):
        if law.has_kink:
            touches = [_by_panels(law, at_surface) for at_surface in (False, law.feels_load)]
            if np.isfinite(touches).any():
                return float(np.nanmin(touches))
        for count in () if law.has_kink else _LEVELS:
            s = scheme(count, max(1, law.root // 2))
            z = _solved(s, law, _start(s, law))
            if z is not None:
                legendre = np.abs(s.spectrum @ z[:count])
                if np.max(legendre[-_TAIL:]) <= _SPECTRUM * np.max(legendre):
                    # The same motion, shifted by half a period, is the solution with -Λ.
                    return abs(float(z[-1]))
    raise ModelError(
        f"no threshold of permanent contact was found for {law.label}, because it is too weakly "
        "damped"
    )


@lru_cache(maxsize=1024)
def known_threshold(law: ContactLaw) -> float:
    """The result of :func:`permanent_contact`, or NaN where no threshold was found.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji
    >>> known_threshold(Tsuji(1e9, 1e-3))
    nan
    """
    try:
        return permanent_contact(law)
    except ModelError:
        return np.nan


@lru_cache(maxsize=4096)
def holds(law: ContactLaw, amplitude: float) -> bool:
    """Whether a steady contact of a single law at Λ was found that never releases the ball.

    The contact at Λ itself is smooth, because it ends well before p = 0, and is found with few
    nodes also where that at the threshold is not. Where it is not found, or if the law has a kink
    or its threshold a closed form, Λ is compared with the threshold.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji
    >>> holds(Tsuji(1e9, 1e-3), 0.5), holds(Tsuji(1e9, 1e-3), 1.5)
    (True, False)
    """
    if law.permanent_contact is None and not law.has_kink:
        s, n = scheme(_LEVELS[1], max(1, law.root // 2)), _LEVELS[1]
        z = _solved(s, law, np.array([0.0] * n + [rest(law), 0.0, np.pi / 2, amplitude]), n + 2)
        # The nodes are closest at the ends of the period, where the load is least. B is the
        # acceleration over that of gravity, times the period.
        if z is not None and np.max(np.abs(s.spectrum[-_TAIL:] @ z[:n])) <= _SPECTRUM:
            return True
    return amplitude <= known_threshold(law)
