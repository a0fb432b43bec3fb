"""A contact seen from outside: an impact at an instant, with a delay, a restitution and a load.

:mod:`bouncing_ball_beyond.models.laws.signature` derives the numbers. Every law and every model has
them as its method ``signature``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Instant(NamedTuple):
    """The signature at an impact speed v, and its derivatives with respect to v.

    ``delay`` t_c, ``restitution`` r, ``load`` σ and ``duration`` D are arrays that broadcast; t_c,
    σ and D are times in units of 1/Ω. ``d_delay``, ``d_restitution``, ``d_load`` and
    ``d_duration`` are the derivatives with respect to v.
    """

    delay: np.ndarray
    restitution: np.ndarray
    load: np.ndarray
    duration: np.ndarray
    d_delay: np.ndarray | float = 0.0
    d_restitution: np.ndarray | float = 0.0
    d_load: np.ndarray | float = 0.0
    d_duration: np.ndarray | float = 0.0

    def at(self, speed: ArrayLike) -> Instant:
        """This signature, which is the same at every speed, in the shape of the speeds."""
        none = 0 * np.asarray(speed, dtype=float)
        return Instant(*(x + none for x in self))

    def tangent(self, speed: ArrayLike, load: ArrayLike) -> tuple[Instant, np.ndarray]:
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


def rigid_instant(restitution: ArrayLike, slope: ArrayLike, speed: ArrayLike) -> Instant:
    """An impact with restitution r(v) at the table's level: no delay, no load, no duration.

    ``slope`` is d(r v)/dv.
    """
    v = np.asarray(speed, dtype=float)
    r = np.asarray(restitution, dtype=float)
    none = np.zeros_like(v)[()]
    return Instant(
        delay=none,
        restitution=r + none,
        load=none,
        duration=none,
        d_restitution=(np.asarray(slope) - r) / v,
    )
