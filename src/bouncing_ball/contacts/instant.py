"""The signature of a contact at one impact speed, see :mod:`bouncing_ball.contacts.signature`."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Instant(NamedTuple):
    """The signature at an impact speed v, and its derivatives with respect to v.

    ``delay`` t_c, ``restitution`` r, ``load`` σ and ``duration`` D are arrays that broadcast; t_c,
    σ and D are times in units of 1/Ω. ``d_delay``, ``d_restitution`` and ``d_load`` are the
    derivatives of t_c, r and σ with respect to v.
    """

    delay: np.ndarray
    restitution: np.ndarray
    load: np.ndarray
    duration: np.ndarray
    d_delay: np.ndarray | float = 0.0
    d_restitution: np.ndarray | float = 0.0
    d_load: np.ndarray | float = 0.0

    def tangent(self, speed: ArrayLike, load: ArrayLike) -> "tuple[Instant, np.ndarray]":
        """The constant signature that agrees with this one to first order near v, under a load a.

        Its restitution is ``b = ∂(r v + σ a)/∂v = r + r′ v + σ′ a`` and its delay ``e = ∂(v t_c)/∂v
        = t_c + t_c′ v``. The second result is the number (b - r) v₀ at the given speed v₀, so that
        ``r_c v = b v + σ a - (b - r) v₀`` to first order about v₀. For a constant signature b = r
        and e = t_c, and the second result is 0.

        Examples
        --------
        >>> instant, rest = Instant(1.0, 0.5, 0.0, 2.0, d_restitution=-0.125).tangent(2.0, 0.0)
        >>> float(instant.restitution), float(rest)
        (0.25, -0.5)
        """
        v = np.asarray(speed, dtype=float)
        slope = self.restitution + (self.d_restitution * v + self.d_load * np.asarray(load))
        depth = self.delay + self.d_delay * v
        return Instant(depth, slope, self.load, self.duration), (slope - self.restitution) * v
