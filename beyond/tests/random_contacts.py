"""Random contacts with orbits, the corners of their range among them."""

import numpy as np


def drawn_contacts(size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """ϖ, r, n, and shares between 0 and 1 for the Λ of orbits, rows of a length.

    Below r = 0.35 the branch of a compliant contact may have no fold.
    """
    rng = np.random.default_rng(11)
    n = rng.integers(1, 6, size)
    share = rng.uniform(0.01, 0.99, size)
    omega = np.exp(rng.uniform(*np.log([2.0, 1e4]), size))
    r = rng.uniform(0.35, 0.9999, size)
    omega[::10] = 2.0
    omega[1::10] = 1e4
    r[::7] = 0.35
    r[1::7] = 1.0
    return omega, r, n, share
