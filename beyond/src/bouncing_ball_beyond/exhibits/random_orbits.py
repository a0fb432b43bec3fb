"""Random n-T orbits, on which stages measure errors."""

from collections.abc import Sequence

import numpy as np

from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.one_impact import n_t

# The smallest share of the distance from the saddle-node, as a power of ten.
_NEAREST = -8.0


def random_orbits(
    size: int, seed: int | Sequence[int], release: Release, places: tuple[float, float] = (0.0, 1.0)
):
    """Random (n, ζ, Λ) in the stable range of the restitution model, and the generator.

    r is uniform between 0.05 and 0.98, or from 0.15 with the force release, whose linear contacts
    have r > e⁻²; n is uniform from 1 to 5, and Λ uniform in the part ``places`` of the range from
    the saddle-node (0) to the period doubling (1).

    Parameters
    ----------
    size : int
    seed : int or sequence of int
    release : Release
    places : tuple of float

    Returns
    -------
    n, damping_ratio, amplitude : ndarray, shape (size,)
    generator : numpy.random.Generator
        In the state after these draws.

    Examples
    --------
    >>> n, zeta, lam, _ = random_orbits(100, 1, Release.DISPLACEMENT)
    >>> bool(np.all((n >= 1) & (n <= 5) & (zeta > 0) & (zeta < 1) & (lam > 0)))
    True
    """
    rng = np.random.default_rng(seed)
    lowest = 0.15 if release is Release.FORCE else 0.05
    r = rng.uniform(lowest, 0.98, size)
    n = rng.integers(1, 6, size)
    model = RestitutionModel(r)
    low = n_t.saddle_node(model, n).amplitude
    high = n_t.period_doubling(model, n).amplitude
    lam = low + rng.uniform(*places, size) * (high - low)
    zeta = damping_ratio(r, release)
    return n, zeta, lam, rng


def half_next_to_saddle_node(
    n: np.ndarray, restitution: np.ndarray, amplitude: np.ndarray, generator: np.random.Generator
) -> np.ndarray:
    """Amplitudes of which a random half is moved next to the saddle-node of the restitution model.

    What is left of the distance from it is a share between 10⁻⁸ and 1, uniform in its logarithm.
    Even draws from the stable range hardly meet the saddle-node, where errors of the height change
    their order.

    Examples
    --------
    >>> n, r = np.ones(1000, dtype=int), np.full(1000, 0.5)
    >>> lam = half_next_to_saddle_node(n, r, np.full(1000, 1.3), np.random.default_rng(1))
    >>> share = (lam - np.pi / 3) / (1.3 - np.pi / 3)
    >>> bool(np.all((share > 0.9e-8) & (share <= 1))), round(float(np.mean(share < 1)), 1)
    (True, 0.5)
    """
    low = restitution_saddle_node(n, restitution)
    near = low + 10 ** generator.uniform(_NEAREST, 0, amplitude.shape) * (amplitude - low)
    return np.where(generator.random(amplitude.shape) < 0.5, amplitude, near)
