"""n-T orbits of the spring-damper model: their contacts, equations and stability."""

from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.linear_contact import LinearContactDynamics
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.orbit import Orbit, as_columns
from bouncing_ball.periodic.spring_damper_branch import BranchPoint, branch_point


class SpringDamperOrbit(Orbit):
    """n-T orbits of the spring-damper model; ``law`` is the :class:`SpringDamper`.

    Examples
    --------
    >>> from bouncing_ball.periodic.spring_damper_model import SpringDamperModel
    >>> orbit = SpringDamperModel(SpringDamper(5.0, 0.0)).orbit(1, 0.5)
    >>> float(orbit.determinant())
    1.0
    """

    dynamics = LinearContactDynamics.of

    @classmethod
    def from_branch(cls, point: BranchPoint, contact: SpringDamper, n: ArrayLike) -> Self:
        """The orbits at points of the closed-form branch."""
        return cls(
            n=n,
            law=contact,
            amplitude=point.amplitude,
            phase=point.phase,
            contact_duration=point.contact_duration,
            impact_velocity=point.u + point.x,
        )

    @classmethod
    def on_branch(cls, excess: ArrayLike, contact: SpringDamper, n: ArrayLike) -> Self:
        """The orbits with excess angles ε of the contact; NaN where ε is NaN.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        return cls.from_branch(branch_point(excess, contact, n), contact, n)

    @classmethod
    def at(
        cls, n: ArrayLike, law: SpringDamper, amplitude: np.ndarray, *unknowns: np.ndarray
    ) -> Self:
        """The orbits with these :attr:`unknowns`, which need not be solutions."""
        phase, velocity, angle = unknowns
        return cls(n, law, amplitude, phase, angle / law.frequency_ratio, velocity)

    @property
    def unknowns(self) -> tuple[np.ndarray, ...]:
        """(φ, z′_i, ϖ τ_b): the duration is measured in units of 1/ϖ and is then of order one."""
        return *super().unknowns, self.contact_duration * self.clock

    @property
    def clock(self) -> ArrayLike:
        """ϖ, the frequency of the contact over that of the table."""
        return self.law.frequency_ratio

    def contact_flow(self, time: np.ndarray) -> Any:
        """The :class:`.ContactFlow` at times 0 ≤ τ ≤ τ_b."""
        u = self.relative_impact_velocity
        return self.law.flow(time, 0.0, u, self.phase, self.amplitude)

    @cached_property
    def _end(self) -> Any:
        """The flow at the end of the contact, which the equations and their Jacobian share."""
        return self.contact_flow(self.contact_duration)

    def contact_motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ τ ≤ τ_b in contact (Eqs. 12-13), of the shape of the times."""
        return self.contact_flow(time)[:2]

    def residual(self) -> np.ndarray:
        """Release, velocity and landing defects (Eqs. 23-25), shape (..., 3).

        The release defect is ϖ (δ_b + κ δ′_b). Like the second defect, it is of the order of a
        velocity.
        """
        flow = self._end
        contact = self.law
        release = contact.frequency_ratio * flow.displacement
        release = release + 2 * contact.release_sine * flow.velocity
        velocity, landing = self.flight_defects(flow.displacement, flow.velocity)
        return np.stack([release, velocity, landing], axis=-1)

    def contact_jacobian(self) -> np.ndarray:
        """Jacobian of (τ_b, δ_b, δ′_b) in (τ, δ′, Λ) at the impact, shape (..., 3, 3).

        The duration is differentiated through the release condition δ_b + κ δ′_b = 0. It has no
        derivative, and the entries are NaN, where the release function only touches 0.
        """
        # Rows δ, δ′; columns (τ, δ′, Λ) of the start. The last array is the derivative in time.
        jacobian = self._end.jacobian
        state = jacobian[..., [3, 2, 4]]
        by_time = jacobian[..., 0]
        lag = np.asarray(self.law.lag)
        released = state[..., 0, :] + lag[..., np.newaxis] * state[..., 1, :]
        pace = by_time[..., 0] + lag * by_time[..., 1]
        duration = -released / np.where(pace == 0, np.nan, pace)[..., np.newaxis]
        state = state + by_time[..., :, np.newaxis] * duration[..., np.newaxis, :]
        return np.concatenate([duration[..., np.newaxis, :], state], axis=-2)

    def system_jacobian(self) -> np.ndarray:
        """Exact derivatives of the three residuals by (φ, z′_i, ϖ τ_b, Λ), shape (..., 3, 4)."""
        by_time, _, by_rate, by_phase, by_lam = np.moveaxis(self._end.jacobian, -1, 0)
        omega, sine, cosine, fall = as_columns(
            self.law.frequency_ratio,
            self.law.release_sine,
            np.cos(self.phase),
            self.amplitude * np.sin(self.phase),
        )
        # The flow depends on z′_i, φ and Λ through δ′ = z′_i - Λ cos φ, too.
        columns = (
            by_phase + fall * by_rate,
            by_rate,
            by_time / omega,
            by_lam - cosine * by_rate,
        )
        displacement, velocity = np.moveaxis(np.stack(columns, axis=-1), -2, 0)
        phase, impact, angle, lam = np.eye(4)
        release = omega * displacement + 2 * sine * velocity
        contact = angle / omega, displacement, velocity
        flight = self.flight_jacobian((phase, impact, lam), contact)
        return np.stack([release, *flight], axis=-2)

    def determinant(self) -> np.ndarray:
        """exp(-2ζϖ τ_b), exactly, because areas contract only in contact, at the rate 2ζϖ."""
        loss = np.asarray(self.law.damping_ratio) * self.law.frequency_ratio
        return np.exp(-2 * loss * self.contact_duration)
