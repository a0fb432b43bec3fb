"""The interface of a problem that can be continued."""

from typing import Protocol

import numpy as np


class Problem(Protocol):
    """N equations F(y) = 0 for N unknowns x and one parameter p, with y = (x, p).

    Both methods broadcast over leading axes. The unknowns should be scaled to
    order one, because the arclength is the Euclidean norm of y.
    """

    def residual(self, y: np.ndarray) -> np.ndarray:
        """F(y), shape (..., N) for y of shape (..., N + 1)."""

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """∂F/∂y, shape (..., N, N + 1)."""
