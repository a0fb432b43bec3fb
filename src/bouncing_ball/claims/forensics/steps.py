"""What a continuation with finite steps can print for a bifurcation.

Between the points of a continuation an arclength h apart, the one nearest to
a bifurcation lies within h/2 of it, anywhere. The arclength is that of the
paper's unknowns and its parameter, (z′_i, z′_b, τ_b, φ, A, B, Λ).
"""

import numpy as np

from bouncing_ball.claims.forensics.altered_model import (
    Altered,
    altered_orbit,
    continuation_unknowns,
)

# Samples on each side of the bifurcation.
_SAMPLES = 200


def _unknowns(excess, model):
    return continuation_unknowns(altered_orbit(excess, model), model)


def nearby(excess: np.ndarray, model: Altered, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Signed arclength from a point of the branch, and Λ, on a first axis of samples.

    Parameters
    ----------
    excess : array
        ε of the points; one branch for each.
    reach : float
        Arclength to cover on both sides, about: the samples are equidistant in ε.
    """
    tiny = 1e-6 / (1 + model.frequency_ratio)
    difference = _unknowns(excess + tiny, model) - _unknowns(excess - tiny, model)
    speed = np.sqrt(np.sum(difference**2, axis=0)) / (2 * tiny)
    offsets = np.linspace(-reach, reach, 2 * _SAMPLES + 1)
    grid = excess + offsets.reshape(-1, *(1,) * excess.ndim) / speed
    points = _unknowns(grid, model)
    chords = np.sqrt(np.sum(np.diff(points, axis=1) ** 2, axis=0))
    arc = np.concatenate([np.zeros_like(excess)[np.newaxis], np.cumsum(chords, axis=0)])
    return arc - arc[_SAMPLES], points[-1]


def attainable(
    arc: np.ndarray, amplitude: np.ndarray, step: float | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Smallest and largest Λ within half a step of the bifurcation.

    Examples
    --------
    >>> arc = np.linspace(-1.0, 1.0, 5)[:, np.newaxis]
    >>> [x.tolist() for x in attainable(arc, arc**2, 1.5)]
    [[0.0], [0.625]]
    """
    half = step / 2
    inside = np.abs(arc) <= half
    low = np.where(inside, amplitude, np.inf).min(axis=0)
    high = np.where(inside, amplitude, -np.inf).max(axis=0)
    for end in (-half, half):
        # The ends of the interval lie between two samples.
        value = _interpolated(end, arc, amplitude)
        low, high = np.minimum(low, value), np.maximum(high, value)
    return low, high


def _interpolated(at, arc, amplitude):
    left = np.clip(np.sum(arc <= at, axis=0) - 1, 0, len(arc) - 2)[np.newaxis]
    (s, t), (a, b) = (
        tuple(np.take_along_axis(x, left + k, axis=0)[0] for k in (0, 1)) for x in (arc, amplitude)
    )
    return a + (at - s) / (t - s) * (b - a)


def step_needed(
    arc: np.ndarray, amplitude: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Smallest step for which some Λ in [low, high] is attainable.

    Infinite if no sample reaches it. Exact to the linear interpolation between the samples.

    Examples
    --------
    >>> arc = np.linspace(-1.0, 1.0, 201)[:, np.newaxis]
    >>> step_needed(arc, arc**2, np.array([0.25]), np.array([0.3])).round(6).tolist()
    [1.0]
    >>> step_needed(arc, arc**2, np.array([-0.2]), np.array([-0.1])).tolist()
    [inf]
    """
    distance = np.where((amplitude >= low) & (amplitude <= high), np.abs(arc), np.inf)
    for level in (low, high):
        before, after = amplitude[:-1] - level, amplitude[1:] - level
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = arc[:-1] + before / (before - after) * (arc[1:] - arc[:-1])
        crossed = (before < 0) != (after < 0)
        distance = np.concatenate([distance, np.where(crossed, np.abs(crossing), np.inf)])
    return 2 * distance.min(axis=0)
