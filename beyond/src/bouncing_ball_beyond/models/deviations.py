"""Growth of small deviations of a ball from one impact to the next.

A deviation (dφ, dδ, dδ′) is mapped by the linearised flow of a flight or of a contact, and then
along the motion to the next event, ``δ + κ δ′ = 0``. For κ = 0 the event is a landing, and for κ
equal to the lag of a contact it is the release or the resumption of this contact. On such a section
``dδ = -κ dδ′``, so that the two numbers (dφ, dδ′) remain.

The derivative of the flow of a flight depends only on the table's state at the two ends. With
X = Λ cos φ, Y = Λ sin φ, and the index 1 for the end after a time T::

    ∂δ/∂φ = X - X₁ - Y T,    ∂δ′/∂φ = Y₁ - Y,    ∂δ/∂δ′ = T
"""

from typing import NamedTuple, Self

import numpy as np

_ONE = np.array(1.0)


class Deviation(NamedTuple):
    """The deviations dφ, dδ and dδ′ of a ball; arrays with one entry per ball."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray

    @classmethod
    def pair(cls, first: Self, second: Self) -> Self:
        """Two deviations of each ball along a first axis, which are mapped together."""
        return cls(*(np.array(both) for both in zip(first, second, strict=True)))

    def to_event(self, velocity, acceleration, lag) -> Self:
        """The deviation at the event δ + κ δ′ = 0, at which the motion has δ′ and δ″."""
        missing = self.displacement + lag * self.velocity
        later = -missing / (velocity + lag * acceleration)
        return type(self)(
            phase=self.phase + later,
            displacement=self.displacement + velocity * later,
            velocity=self.velocity + acceleration * later,
        )

    def flown(self, start, end, time, velocity, lag) -> Self:
        """The deviation at the event that ends a flight.

        ``start`` and ``end`` are the table's (X, Y) at both ends of the flight, ``time`` is its
        duration, ``velocity`` is δ′ at the event, and ``lag`` is κ.
        """
        x, y = start
        x1, y1 = end
        at_end = type(self)(
            phase=self.phase,
            displacement=self.displacement
            + self.velocity * time
            + self.phase * (x - x1 - y * time),
            velocity=self.velocity + self.phase * (y1 - y),
        )
        return at_end.to_event(velocity, y1 - _ONE, lag)


class Released(NamedTuple):
    """The deviations at the releases of unit deviations of φ and of δ′ at the impacts."""

    by_phase: Deviation
    by_velocity: Deviation


class Jacobian(NamedTuple):
    """The matrix ∂(φ₁, δ′₁)/∂(φ, δ′), row by row, as arrays with one entry per ball."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray

    @classmethod
    def of_columns(cls, images: Deviation) -> Self:
        """The matrix whose columns are the images of (1, 0) and of (0, 1), a pair of deviations."""
        return cls(*images.phase, *images.velocity)

    @classmethod
    def identity(cls, balls: int) -> Self:
        """The identity matrix for each of this number of balls."""
        return cls(np.ones(balls), np.zeros(balls), np.zeros(balls), np.ones(balls))

    def apply(self, phase: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The image of a deviation (dφ, dδ′)."""
        return self.a * phase + self.b * velocity, self.c * phase + self.d * velocity

    def after(self, first: "Jacobian") -> "Jacobian":
        """The product of this matrix with ``first``, which acts first."""
        a, c = self.apply(first.a, first.c)
        b, d = self.apply(first.b, first.d)
        return Jacobian(a, b, c, d)

    def spectral_radius(self) -> np.ndarray:
        """The larger modulus of the two multipliers, which are the eigenvalues of the matrix.

        Examples
        --------
        >>> float(Jacobian(*np.array([0.0, -0.25, 1.0, 0.0])).spectral_radius())
        0.5
        """
        half_trace = (self.a + self.d) / 2
        det = self.a * self.d - self.b * self.c
        square = half_trace * half_trace - det
        if_real = np.abs(half_trace) + np.sqrt(np.maximum(square, 0.0))
        if_complex = np.sqrt(np.maximum(det, 0.0))
        return np.where(square < 0, if_complex, if_real)

    def to_fixed_point(
        self, phase: np.ndarray, velocity: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Newton's step to a fixed point: (I - M)⁻¹ applied to (φ₁ - φ, δ′₁ - δ′)."""
        a = 1 - self.a
        d = 1 - self.d
        det = a * d - self.b * self.c
        return (d * phase + self.b * velocity) / det, (self.c * phase + a * velocity) / det
