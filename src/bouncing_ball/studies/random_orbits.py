"""Random orbits of the whole stable range of the restitution model."""

from collections.abc import Sequence

import numpy as np

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.restitution_model import RestitutionModel


def random_orbits(
    size: int, seed: int | Sequence[int], release: Release, places: tuple[float, float] = (0.0, 1.0)
):
    """Random (n, ζ, Λ) in the stable range of the restitution model, ``places`` of it.

    r is even from 0.05 to 0.98, from 0.15 with the force release, whose linear
    contacts go down to e⁻² only; n from 1 to 5.
    """
    rng = np.random.default_rng(seed)
    lowest = 0.15 if release is Release.FORCE else 0.05
    r = rng.uniform(lowest, 0.98, size)
    n, model = rng.integers(1, 6, size), RestitutionModel(r)
    low, high = model.saddle_node(n).amplitude, model.period_doubling(n).amplitude
    lam = low + rng.uniform(*places, size) * (high - low)
    zeta = SpringDamper.from_restitution(r, 1.0, release, measured=True).damping_ratio
    return n, zeta, lam, rng
