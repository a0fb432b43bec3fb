r"""The steady contact of a law in which the ball never leaves the table, and its largest Λ.

The spring and damper has a closed form (:mod:`bouncing_ball_beyond.models.permanent_contact`, Eqs.
28-36), which its law gives as ``permanent_contact``. Most other laws have none. At the threshold
the grip g vanishes exactly once per period and does not change its sign. The steady motion is then
a solution of the boundary value problem ::

    p″ = a - f(p, p′),   a = 1 - Λ sin(φ + t),   0 ≤ t ≤ 2π
    p(0) = p(2π),   p′(0) = p′(2π),   g = 0 and dg/dt = 0 at t = 0

where φ and Λ are unknown too; for a release at p = 0 the last two equations are p = p′ = 0. It is
solved by scipy's collocation, whose adaptive grid also resolves the kinks of a law. If a contact
also ends at p = 0, the ball may touch the surface, p = p′ = 0, before the grip vanishes.

The iteration starts from a motion that is integrated over one period from p = p′ = 0. A ball on a
Hertzian contact of the depth p₁ at rest has p = p₁ (t²/2)^{2/3} there, next to the least load
a = t²/2, except within a time of about p₁^{3/8}, in which its inertia counts; the start is later
than the least load by this time. A weakly damped contact near a resonance has several steady
motions at the same Λ. A solution is refused if a ball is still held at a larger Λ.

All quantities are dimensionless.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw, under
from bouncing_ball_beyond.models.laws.scales import depth, rest

_PERIOD = 2 * np.pi
# The largest size of the grid and the tolerance of the relative residual. The error of Λ is below
# 10⁻¹⁰ then, because the residual changes its sign within every interval. At a given Λ less is
# enough, also for the first grid and for the motion from which the iteration starts.
_MOST = 200_000
_TOLERANCE = 1e-8
_GRID = 60
_FEW = 5_000
_COARSE = 1e-6
_FIRST = 1e-5
# The ratio of the larger Λ to the threshold. It skips the fold of a resonance, next to which the
# threshold may be; a steady contact beyond it makes an answer wrong by more than 1 %.
_ABOVE = 1.01
# Rounding of the grip over its value at rest.
_SLACK = 1e-7
# The depth at rest, over g/Ω², below which no threshold is sought: a step of the integration from
# which the iteration starts is about its root, so that there would be a hundred thousand.
_STIFF = 1e-9
_TINY = 1e-300
# An imaginary step in time.
_STEP = 1e-20j


class _Steady(NamedTuple):
    """The equations of a steady contact of one law, with its depth at rest as the unit of p."""

    law: ForceLaw
    unit: float

    def grip(self, p: np.ndarray, u: np.ndarray, load: Any) -> np.ndarray:
        """The grip over that at rest."""
        full = under(self.law, 1.0).grip(np.array(self.unit), np.array(0.0))
        return under(self.law, load).grip(p, u) / full

    def state(self, time: ArrayLike, y: np.ndarray, z: np.ndarray):
        """p, p′ and the load; z has φ and Λ."""
        # Roots exist for p ≥ 0 only.
        p = np.maximum(self.unit * y[0], _TINY) if self.law.root > 1 else self.unit * y[0]
        return p, self.unit * y[1], 1 - z[1] * np.sin(z[0] + time)

    def rates(self, time: ArrayLike, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        """The rates of change of y."""
        p, u, load = self.state(time, y, z)
        return np.array([u, load - under(self.law, load).force(p, u)]) / self.unit

    def release(self, first: np.ndarray, z: np.ndarray) -> tuple[Any, Any]:
        """The grip at the start and its rate of change."""
        p, u, load = self.state(0.0, first, z)
        p_rate, u_rate = self.unit * self.rates(0.0, first, z)
        load_rate = -z[1] * np.cos(z[0])
        moved = self.grip(p + _STEP * p_rate, u + _STEP * u_rate, load + _STEP * load_rate)
        return moved.real, moved.imag / _STEP.imag

    def is_held(self, found: Any, z: np.ndarray) -> bool:
        """Whether a solution was found that never releases the ball."""
        held = self.grip(*self.state(found.x, found.y, z))
        if self.law.root > 1 or isinstance(self.law, LoadedLaw):
            held = np.minimum(held, found.y[0])
        return bool(found.success and np.min(held) > -_SLACK)


def _touching(law: ForceLaw, at_surface: bool) -> float:
    """Λ of the steady contact that just reaches its release, or that touches the surface; NaN if
    none was found.
    """
    steady = _Steady(law, rest(law))
    if steady.unit < _STIFF:
        return np.nan
    at_surface |= law.release.at_surface

    def ends(first: np.ndarray, last: np.ndarray, z: np.ndarray) -> np.ndarray:
        touch = first if at_surface else steady.release(first, z)
        return np.array([*touch, *(last - first)])

    late = steady.unit**0.375
    # The load is least at π/2.
    z = np.array([np.pi / 2 + late, 1 - late * late / 2])
    run = scipy.integrate.solve_ivp(
        steady.rates, (0, _PERIOD), np.zeros(2), args=(z,), rtol=_FIRST, atol=_FIRST
    )
    found = scipy.integrate.solve_bvp(
        steady.rates, ends, run.t, run.y, z, tol=_TOLERANCE, max_nodes=_MOST
    )
    if not steady.is_held(found, found.p):
        return np.nan
    # The same motion, shifted by half a period, is the solution with -Λ.
    return abs(float(found.p[1]))


def _holds(law: ForceLaw, amplitude: float) -> bool:
    """Whether the steady contact at Λ that is next to a slow motion never releases the ball."""
    steady = _Steady(law, rest(law))
    z = np.array([np.pi / 2, amplitude])
    time = np.linspace(0.0, _PERIOD, _GRID)
    load = np.maximum(1 - amplitude * np.cos(time), _SLACK)
    slow = np.array([depth(law, 0 * time, 0.0, load) / steady.unit, 0 * time])
    found = scipy.integrate.solve_bvp(
        lambda t, y: steady.rates(t, y, z),
        lambda first, last: last - first,
        time,
        slow,
        tol=_COARSE,
        max_nodes=_FEW,
    )
    return steady.is_held(found, z)


def permanent_contact(law: ForceLaw) -> float:
    """The largest Λ of permanent contact of a single law.

    Raises
    ------
    ModelError
        If no steady contact was found whose grip vanishes once per period.

    Examples
    --------
    Λ_SD = √13/4 for ϖ = 2 and ζ = 1/2:

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> round(permanent_contact(SpringDamper(2.0, 0.5)) / 13**0.5, 15)
    0.25
    """
    if law.permanent_contact is not None:
        return float(law.permanent_contact)
    # If the contact that touches the surface is held throughout, the grip vanishes later.
    for at_surface in (True, False) if isinstance(law, LoadedLaw) else (False,):
        with np.errstate(all="ignore"):
            found = _touching(law, at_surface)
            if np.isfinite(found) and not _holds(law, _ABOVE * found):
                return found
    raise ModelError(
        f"no threshold of permanent contact was found for {law.label}, because it is too weakly "
        f"damped or too stiff (a depth at rest below {_STIFF:g} g/Ω²)"
    )


@lru_cache(maxsize=1024)
def known_threshold(law: ForceLaw) -> float:
    """The result of :func:`permanent_contact`, or NaN where no threshold was found.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> round(known_threshold(SpringDamper(2.0, 0.5)) / 13**0.5, 15)
    0.25
    """
    try:
        return permanent_contact(law)
    except ModelError:
        return np.nan


@lru_cache(maxsize=4096)
def holds(law: ForceLaw, amplitude: float) -> bool:
    """Whether a steady contact of a single law at Λ was found that never releases the ball.

    Λ is compared with the threshold. If that was not found, the steady contact at Λ itself is
    sought, which is smooth because its force does not vanish.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> holds(SpringDamper(2.0, 0.5), 0.5), holds(SpringDamper(2.0, 0.5), 1.5)
    (True, False)
    """
    threshold = known_threshold(law)
    if np.isfinite(threshold):
        return amplitude <= threshold
    with np.errstate(all="ignore"):
        return _holds(law, amplitude)
