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
and does not change its sign. The steady motion is then a solution of the boundary value problem ::

    p″ = a - f(p, p′),   a = 1 - Λ sin(φ + t),   0 ≤ t ≤ 2π
    p(0) = p(2π),   p′(0) = p′(2π),   g = 0 and dg/dt = 0 at t = 0

where φ and Λ are unknown too; for a release at p = 0 the last two equations are p = p′ = 0. It is
solved by scipy's collocation, whose adaptive grid also resolves the kinks of a law. If the force
depends on the load, the ball may also touch the surface, p = p′ = 0, before the grip vanishes.

All quantities are dimensionless.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.contact_scales import depth, rest
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import permanent_contact_threshold
from bouncing_ball.errors import ModelError, require

_PERIOD = 2 * np.pi
# The first grid, its largest size, and the tolerance of the relative residual. The error of Λ is
# below 10⁻¹¹ then, because the residual changes its sign within every interval. At a given Λ less
# is enough.
_GRID, _MOST, _TOLERANCE = 60, 100_000, 1e-9
_FEW, _COARSE = 20_000, 1e-6
# Rounding of the grip over its value at rest.
_SLACK = 1e-7
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


def _steady(law: ContactLaw, at_surface: bool = False, amplitude: float = np.nan) -> float:
    """Λ of the steady contact that just reaches its release, or that touches the surface.

    With an ``amplitude`` it is this Λ if its steady contact never releases the ball. The result is
    NaN if no such contact was found.
    """
    # Imported here because it takes a third of a second, and most laws have a closed form.
    from scipy.integrate import solve_bvp

    unit, given = rest(law), np.isfinite(amplitude)
    known = np.array([np.pi / 2, amplitude])

    def state(time: ArrayLike, y: np.ndarray, z: np.ndarray):
        """p, p′ and the load."""
        # Roots exist for p ≥ 0 only.
        p = np.maximum(unit * y[0], _TINY) if law.root > 1 else unit * y[0]
        return p, unit * y[1], 1 - z[1] * np.sin(z[0] + time)

    def rates(time: np.ndarray, y: np.ndarray, z: np.ndarray = known) -> np.ndarray:
        p, u, load = state(time, y, z)
        return np.array([u, load - law.loaded_force(p, u, load)]) / unit

    def ends(first: np.ndarray, last: np.ndarray, z: np.ndarray = known) -> np.ndarray:
        if given:
            return last - first
        if at_surface or law.release is Release.DISPLACEMENT:
            return np.array([*first, *(last - first)])
        here, step = state(0.0, first, z), 1e-20j
        along = unit * first[1], unit * rates(np.zeros(1), first[:, np.newaxis], z)[1, 0]
        moved = zip(here, (*along, -z[1] * np.cos(z[0])), strict=True)
        falls = np.imag(law.loaded_grip(*(x + step * rate for x, rate in moved))) / step.imag
        return np.array([law.loaded_grip(*here) / full, falls / full, *(last - first)])

    full = law.loaded_grip(np.array(unit), np.array(0.0), 1.0)
    time = np.linspace(0.0, _PERIOD, _GRID)
    if given:
        # The table moves slowly against a stiff contact.
        load = np.maximum(state(time, np.ones((2, 1)), known)[2], _SLACK)
        guess = [depth(law, 0 * time, 0.0, load) / unit, 0 * time]
        found = solve_bvp(rates, ends, time, guess, tol=_COARSE, max_nodes=_FEW)
    else:
        guess, z = [1 - np.cos(time), np.sin(time)], np.array([np.pi / 2, 1.0])
        found = solve_bvp(rates, ends, time, guess, z, tol=_TOLERANCE, max_nodes=_MOST)
    z = known if given else found.p
    p, u, load = state(found.x, found.y, z)
    held = law.loaded_grip(p, u, load) / full
    if law.root > 1 or law.feels_load:
        held = np.minimum(held, found.y[0])
    # The same motion, shifted by half a period, is the solution with -Λ.
    return abs(float(z[1])) if found.success and np.min(held) > -_SLACK else np.nan


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
    >>> round(permanent_contact(SpringDamper(2.0, 0.5)) / 13**0.5, 9)
    0.25
    """
    if law.permanent_contact is not None:
        return float(law.permanent_contact)
    # If the contact that touches the surface is held throughout, the grip vanishes later.
    for at_surface in (True, False) if law.feels_load else (False,):
        with np.errstate(all="ignore"):
            found = _steady(law, at_surface)
        if np.isfinite(found):
            return found
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

    Λ is compared with the threshold. If that was not found, the steady contact at Λ itself is
    sought, which is smooth because its force does not vanish.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji
    >>> holds(Tsuji(1e9, 1e-3), 0.5), holds(Tsuji(1e9, 1e-3), 1.5)
    (True, False)
    """
    threshold = known_threshold(law)
    if np.isfinite(threshold):
        return amplitude <= threshold
    with np.errstate(all="ignore"):
        return bool(np.isfinite(_steady(law, amplitude=amplitude)))
