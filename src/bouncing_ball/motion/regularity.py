"""Periods of motions, and the rate at which neighbouring motions separate.

The largest Lyapunov exponent is the mean logarithm of the stretching of a small
perturbation from impact to impact, here by the exact Jacobian of the impact map.
If it is positive, neighbours separate exponentially. It is a mean over a finite motion. After a
ball has stuck to the table its later motion does not depend on earlier impacts, so that the
measurement ends there.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.motion.sequence import ImpactSequence


def period(sequence: ImpactSequence, longest: int, closeness: float) -> np.ndarray:
    """The number of impacts after which each motion repeats at its end; 0 if it does not.

    Parameters
    ----------
    sequence : ImpactSequence
    longest : int
        The longest period considered; the last ``longest`` impacts must all have
        a partner one period earlier.
    closeness : float
        Differences in phase and relative velocity that count as none.

    Raises
    ------
    ValueError
        If the sequence is shorter than twice the longest period.

    Examples
    --------
    >>> from bouncing_ball.motion.simulation import simulate
    >>> period(simulate(1.0, 0.0, 0.0, -np.pi, 8), 4, 1e-9).tolist()
    1
    """
    rows = len(sequence.time)
    if rows < 2 * longest:
        raise ValueError(
            f"{rows} impacts are too few to find a period of {longest}: "
            f"at least {2 * longest} are needed"
        )
    found = np.zeros(sequence.status.shape, dtype=int)
    last = slice(rows - longest, rows)
    for k in range(longest, 0, -1):
        before = slice(last.start - k, last.stop - k)
        turned = reduce_angle(sequence.phase[last] - sequence.phase[before])
        faster = sequence.relative_velocity[last] - sequence.relative_velocity[before]
        same = np.maximum(np.abs(turned), np.abs(faster)).max(axis=0) < closeness
        found[same] = k
    return found


def exact_map_jacobian(
    flight_time: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
    restitution: ArrayLike,
) -> np.ndarray:
    """Jacobian of the exact map (τ, v) → (τ₁, v₁) (Eq. 5), shape (..., 2, 2).

    ``phase`` and ``velocity`` are τ and v just after an impact, in absolute terms; ``flight_time``
    s must solve the landing condition, whose differential is ``ds = -(∂gap/∂τ dτ + s dv)/(v - s - Λ
    cos τ₁)``. The determinant is ``r² (v - Λ cos τ)/(v₁ - Λ cos τ₁)`` in these coordinates.

    Examples
    --------
    On a table at rest a flight of 2v returns to the velocity r v:

    >>> np.abs(exact_map_jacobian(4.0, 0.0, 2.0, 0.0, 0.5)).tolist()
    [[1.0, 2.0], [0.0, 0.5]]
    """
    s, tau, v, lam, r = np.broadcast_arrays(flight_time, phase, velocity, amplitude, restitution)
    landing = tau + s
    closing = v - s - lam * np.cos(landing)
    s_tau = lam * (np.cos(landing) - np.cos(tau)) / closing
    s_v = -s / closing
    # v₁ depends on s through the gravity term and the table's phase.
    forced = -(1 + r) * lam * np.sin(landing)
    rows = [1 + s_tau, s_v], [(r + forced) * s_tau + forced, (r + forced) * s_v - r]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


class Stretching(NamedTuple):
    """Logarithm of the growth of a perturbation, and the number of impacts, for each ball."""

    logarithm: np.ndarray
    impacts: np.ndarray

    def exponent(self) -> tuple[np.ndarray, np.ndarray]:
        """Largest Lyapunov exponent per impact over the balls of the last axis, with its standard
        error.

        NaN where no ball has an impact.

        Examples
        --------
        >>> [float(x) for x in Stretching(np.array([3.0, 5.0]), np.array([4, 4])).exponent()]
        [1.0, 0.25]
        """
        total, balls = self.impacts.sum(axis=-1), self.impacts.shape[-1]
        with np.errstate(invalid="ignore"):
            mean = self.logarithm.sum(axis=-1) / total
            rest = self.logarithm - mean[..., np.newaxis] * self.impacts
            spread = np.sum(rest**2, axis=-1) * balls / max(balls - 1, 1)
            return mean, np.sqrt(spread) / total


def stretching(sequence: ImpactSequence, restitution: float, skip: int) -> Stretching:
    """The separation of balls of the restitution model from their neighbours, until they stick.

    Parameters
    ----------
    sequence : ImpactSequence
        Of the restitution model.
    restitution : float
        r.
    skip : int
        Impacts that are left out at the start, during which the perturbation turns into
        the direction of growth.

    Examples
    --------
    On a table at rest a deviation of the velocity shrinks, and one of the phase remains:

    >>> from bouncing_ball.motion.simulation import simulate
    >>> parting = stretching(simulate(0.5, 0.0, 0.0, [-8.0, -6.0], 16), 0.5, 12)
    >>> round(float(parting.exponent()[0]), 5), parting.impacts.tolist()
    (0.0, [3, 3])
    """
    flight = np.diff(sequence.time, axis=0)
    free = np.logical_and.accumulate(sequence.contact_duration[:-1] == 0, axis=0)
    free &= np.isfinite(flight)
    jacobian = np.broadcast_to(np.eye(2), (*flight.shape, 2, 2)).copy()
    jacobian[free] = exact_map_jacobian(
        flight[free],
        sequence.phase[:-1][free],
        sequence.bounce_velocity[:-1][free],
        np.broadcast_to(sequence.amplitude, flight.shape)[free],
        restitution,
    )
    growth = np.zeros(flight.shape)
    along = np.broadcast_to([[1.0], [0.0]], (*flight.shape[1:], 2, 1))
    for row, step in enumerate(jacobian):
        along = step @ along
        length = np.linalg.norm(along, axis=-2, keepdims=True)
        along, growth[row] = along / length, np.log(length[..., 0, 0])
    return Stretching(growth[skip:].sum(axis=0), free[skip:].sum(axis=0))
