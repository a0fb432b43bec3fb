"""Random n-T orbits, on which stages measure errors."""

from collections.abc import Sequence

import numpy as np

from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.one_impact import n_t


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
