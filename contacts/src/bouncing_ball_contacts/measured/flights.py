r"""Impact speeds and restitution from heights or from times of impacts, with the drag of the air.

The drag of a ball with the speed u is m u²/ℓ, with the *drag length* ``ℓ = 2m/(ρ C_d A)``. With the
terminal speed ``w = √(gℓ)`` a ball that is dropped from the height h meets the table with v, and a
ball that leaves it with u rises to h′ ::

    v² = w² (1 - e^{-2h/ℓ}),      u² = w² (e^{2h′/ℓ} - 1)

A ball that leaves with u = s w comes back with ``v = u/√(1 + s²)`` after the time ::

    T = (w/g) (arctan s + arsinh s)

Without drag these are √(2gh), √(2gh′), v = u and T = 2u/g. Both follow from one integration of
u u′ = -g ∓ u²/ℓ over the height and of u′ over time.

If the times of impacts have independent errors of the standard deviation σ, then the mean of the
ratio of two successive intervals is, to second order in σ, larger than the ratio of their means by
the factor ``1 + 2σ²/T₁² + σ²/(T₁T₂)``, because T₁ is a denominator and the errors of both intervals
share that of the impact between them.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, require
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY

AIR_DENSITY = 1.2
"""Density of air in kg/m³, at 20 °C and 1 atm to two digits."""
SPHERE_DRAG = 0.47
"""Drag coefficient of a smooth sphere at Reynolds numbers of 10³ to 10⁵, as in the report of A.
Vasquez on a plastic ball (``data/plastic_ball.csv``)."""
# Newton steps for s; the error is squared by each.
_STEPS = 8


def drag_length(
    mass: float,
    diameter: float,
    drag_coefficient: float = SPHERE_DRAG,
    air_density: float = AIR_DENSITY,
) -> float:
    """ℓ = 2m/(ρ C_d A) in m.

    Examples
    --------
    >>> round(drag_length(0.0096, 0.025), 1)
    69.4
    """
    return 2 * mass / (air_density * drag_coefficient * math.pi * diameter**2 / 4)


def drop_speeds(
    height: ArrayLike, rebound: ArrayLike, length: float = math.inf
) -> tuple[np.ndarray, np.ndarray]:
    """Speeds in m/s before and after the impact in a drop test, from heights in m.

    Examples
    --------
    >>> v, u = drop_speeds(1.0, 0.25)
    >>> round(float(u / v), 12)
    0.5
    """
    h = np.asarray(height, dtype=float)
    back = np.asarray(rebound, dtype=float)
    require((h > 0) & np.isfinite(h), h, "drop height", "a finite height > 0")
    require((back > 0) & (back <= h), back, "rebound height", "> 0 and at most the drop height")
    g = STANDARD_GRAVITY
    if math.isinf(length):
        return np.sqrt(2 * g * h), np.sqrt(2 * g * back)
    terminal = g * length
    v = np.sqrt(-terminal * np.expm1(-2 * h / length))
    return v, np.sqrt(terminal * np.expm1(2 * back / length))


def flight_speeds(time: ArrayLike, length: float = math.inf) -> tuple[np.ndarray, np.ndarray]:
    """Speeds in m/s at the start and at the end of flights that last so many seconds.

    Examples
    --------
    >>> up, down = flight_speeds([0.5, 1.0], length=20.0)
    >>> s = up / math.sqrt(STANDARD_GRAVITY * 20.0)
    >>> back = math.sqrt(20.0 / STANDARD_GRAVITY) * (np.arctan(s) + np.arcsinh(s))
    >>> back.round(12).tolist(), bool(np.all(down < up))
    ([0.5, 1.0], True)
    """
    t = np.asarray(time, dtype=float)
    g = STANDARD_GRAVITY
    if math.isinf(length):
        return g * t / 2, g * t / 2
    terminal = math.sqrt(g * length)
    wanted = g * t / terminal
    s = wanted / 2
    for _ in range(_STEPS):
        root = np.sqrt(1 + s * s)
        s = s - (np.arctan(s) + np.arcsinh(s) - wanted) / (1 / (1 + s * s) + 1 / root)
    return terminal * s, terminal * s / np.sqrt(1 + s * s)


def by_height(speed: ArrayLike, restitution: ArrayLike) -> np.ndarray:
    """Error of a restitution coefficient by an error of 1 m of the height of the rebound.

    With ``e = √(h′/h)`` and ``h′ = (e v)²/(2g)`` it is ``e/(2h′) = g/(e v²)`` per metre.

    Parameters
    ----------
    speed, restitution : array_like
        Impact speeds v in m/s, and restitution coefficients e.

    Examples
    --------
    >>> v, u = drop_speeds([1.0, 1.0], [0.25, 0.2501])
    >>> e = u / v
    >>> round(float((e[1] - e[0]) / 1e-4), 3), round(float(by_height(v, e)[0]), 3)
    (1.0, 1.0)
    """
    v = np.asarray(speed, dtype=float)
    return STANDARD_GRAVITY / (np.asarray(restitution, dtype=float) * v**2)


@dataclass(frozen=True)
class Heard:
    """Impacts of a ball whose times of impact were recorded, one for each pair of intervals.

    Parameters
    ----------
    speeds, restitutions : ndarray
        Impact speeds in m/s, and the restitution coefficients without the two biases.
    covariance : ndarray or None
        Covariance of the restitution coefficients; None if the resolution is not known.
    ratios : ndarray
        The ratios of successive intervals, which are the restitution coefficients with biases.
    drag_bias, resolution_bias : ndarray
        What was removed: the ratio of intervals is less by the drag of the air, and its mean is
        larger by the errors of the times.
    """

    speeds: np.ndarray
    restitutions: np.ndarray
    covariance: np.ndarray | None
    ratios: np.ndarray
    drag_bias: np.ndarray
    resolution_bias: np.ndarray


def heard(
    intervals: ArrayLike,
    *,
    resolution: float | None = None,
    length: float = math.inf,
    contact_time: float = 0.0,
) -> Heard:
    """The impacts between successive flights, from the intervals between impacts in s.

    Parameters
    ----------
    intervals : array_like
        At least two intervals, in the order in which they were heard.
    resolution : float, optional
        Standard deviation of the error of the time of an impact in s.
    length : float
        Drag length ℓ in m; by default there is no drag.
    contact_time : float
        Duration of a contact in s, by which an interval is longer than the flight.

    Raises
    ------
    ModelError
        If there are fewer than two intervals, or one is not longer than the contact.

    Examples
    --------
    >>> heard([0.8, 0.4, 0.2]).restitutions.tolist()
    [0.5, 0.5]
    """
    t = np.asarray(intervals, dtype=float) - contact_time
    if t.ndim != 1 or t.size < 2:
        raise ModelError(f"{t.size} interval: two are needed for the impact between them")
    require(np.isfinite(t) & (t > 0), t, "interval", "a finite time > 0, longer than the contact")
    up, down = flight_speeds(t, length)
    ratio = t[1:] / t[:-1]
    plain = ratio if math.isinf(length) else up[1:] / down[:-1]
    require(plain <= 1, plain, "ratio of successive intervals", "at most 1, as without a loss")
    sigma = resolution or 0.0
    bias = sigma**2 * (2 / t[:-1] ** 2 + 1 / (t[:-1] * t[1:]))
    restitution = plain / (1 + bias)
    return Heard(
        speeds=down[:-1],
        restitutions=restitution,
        covariance=_covariance(restitution, t, sigma) if sigma else None,
        ratios=ratio,
        drag_bias=ratio - plain,
        resolution_bias=plain - restitution,
    )


def together(recordings: Sequence[Heard]) -> Heard:
    """The impacts of several recordings, whose errors are independent.

    Examples
    --------
    >>> one = heard([0.8, 0.4, 0.2])
    >>> together([one, one]).speeds.size
    4
    """
    spreads = [each.covariance for each in recordings if each.covariance is not None]
    return Heard(
        speeds=np.concatenate([each.speeds for each in recordings]),
        restitutions=np.concatenate([each.restitutions for each in recordings]),
        covariance=scipy.linalg.block_diag(*spreads) if spreads else None,
        ratios=np.concatenate([each.ratios for each in recordings]),
        drag_bias=np.concatenate([each.drag_bias for each in recordings]),
        resolution_bias=np.concatenate([each.resolution_bias for each in recordings]),
    )


def _covariance(restitution: np.ndarray, t: np.ndarray, sigma: float) -> np.ndarray:
    """Covariance of the ratios e_i = T_{i+1}/T_i by the derivatives with respect to the times."""
    by_time = np.zeros((restitution.size, t.size + 1))
    for i, e in enumerate(restitution):
        by_time[i, i] = e / t[i]
        by_time[i, i + 1] = -e / t[i] - e / t[i + 1]
        by_time[i, i + 2] = e / t[i + 1]
    return sigma**2 * by_time @ by_time.T
