"""The legs of orbits at some points and at points beside them, and the derivatives that follow.

The derivatives of the equations by the states follow from the tangent maps of the models, and those
by the parameters and of the matrices of the legs are central differences.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bouncing_ball_beyond.periodic.orbits.highest import Tops, tops_of
from bouncing_ball_beyond.periodic.orbits.legs import Legs

# Where the second difference of the height or the velocity of a leg is larger than this and than
# half of the first one, it has no derivative but a jump. A jump that is not noticed spoils a
# solution by 1e-7 of its size.
_JUMP = 1e-3


@dataclass(frozen=True)
class LegsBeside:
    """Points beside some points y, and the legs there.

    The first axis of ``points`` and of the legs has y, and then a pair of points for each direction
    in which y is moved: along the parameters, along all θ and along all v. ``lengths`` are the
    distances of the two points of each pair, shape (..., 1), or (..., k) for θ and v; there may be
    fewer of them, in this order. ``selects`` is that of the equations.
    """

    points: np.ndarray
    lengths: list[np.ndarray]
    legs: Legs
    selects: bool

    @cached_property
    def here(self) -> Legs:
        """The legs at the points y."""
        return self.legs.first()

    @cached_property
    def jacobian(self) -> np.ndarray:
        """The Jacobian of the equations at y, shape (..., N, N + parameters)."""
        legs = self.legs
        *leading, k = legs.duration.shape[1:]
        size = k * (3 if self.selects else 2)
        matrix = np.zeros((*leading, size, self.points.shape[-1]))
        self._fill_states(matrix)
        for j, column in enumerate(range(size, matrix.shape[-1])):
            right, left = self.sides(j, legs.residual)
            slope = self.slope(j, legs.residual)
            if (np.abs(right + left - 2 * legs.residual[0]) > _JUMP).any():
                bend = self.bend(j, column, legs.residual)
                jumps = bend > np.maximum(np.abs(right - left) / 2, _JUMP)
                slope = np.where(jumps, np.nan, slope)
            matrix[..., : 2 * k, column] = slope.reshape(*leading, 2 * k)
            if self.selects:
                matrix[..., 2 * k :, column] = -self.slope(j, legs.ends)
        if self.selects:
            self._fill_durations(matrix)
        return matrix

    def _fill_states(self, matrix: np.ndarray) -> None:
        """The derivatives by the states: L (DP ds_i - ds_{i+1}), where L has the rows (δ′, 0) and
        (-δ″, 1).
        """
        speed = self.legs.velocity[0]
        pull = self.legs.acceleration[0]
        a, b, c, d = (entry[0] for entry in self.legs.tangent_near)
        k = speed.shape[-1]
        for leg in range(k):
            height, rate = (matrix[..., 2 * leg + j, :] for j in (0, 1))
            start, after = 2 * leg, 2 * ((leg + 1) % k)
            height[..., start] = speed[..., leg] * a[..., leg]
            height[..., start + 1] = speed[..., leg] * b[..., leg]
            rate[..., start] = c[..., leg] - pull[..., leg] * a[..., leg]
            rate[..., start + 1] = d[..., leg] - pull[..., leg] * b[..., leg]
            height[..., after] -= speed[..., leg]
            rate[..., after] += pull[..., leg]
            rate[..., after + 1] -= 1

    def _fill_durations(self, matrix: np.ndarray) -> None:
        """The derivatives of the equations of the durations by the states and the durations."""
        by_phase, by_velocity = (slopes[0] for slopes in self.legs.end_slopes)
        k = by_phase.shape[-1]
        for contact in range(k):
            row = matrix[..., 2 * k + contact, :]
            row[..., 2 * contact] = -by_phase[..., contact]
            row[..., 2 * contact + 1] = -by_velocity[..., contact]
            row[..., 2 * k + contact] = 1

    @cached_property
    def tops(self) -> Tops:
        """The highest points within the contacts at the points y."""
        return tops_of(self.here)

    def sides(self, j: int, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The values at the two points of a pair, of values of the legs."""
        return values[1 + 2 * j], values[2 + 2 * j]

    def bend(self, j: int, column: int, values: np.ndarray) -> np.ndarray:
        """The modulus of the second difference of values of the legs over a pair of points, one of
        which is nearer at an end of the range of a parameter, an entry of y; none at the end.
        """
        right, left = self.sides(j, values)
        here, ahead, behind = (self.points[k, ..., column] for k in (0, 1 + 2 * j, 2 + 2 * j))
        axes_of_values = (1,) * (right.ndim - here.ndim)
        ahead, behind = (x.reshape(x.shape + axes_of_values) for x in (ahead - here, here - behind))
        apart = (right - values[0]) * behind - (values[0] - left) * ahead
        return np.abs(apart) * 2 / (ahead + behind)

    def slope(self, j: int, values: np.ndarray) -> np.ndarray:
        """The derivative of values of the legs, by a parameter."""
        right, left = self.sides(j, values)
        length = self.lengths[j]
        axes_of_values = (1,) * (right.ndim - length.ndim)
        return (right - left) / length.reshape(length.shape + axes_of_values)
