"""The corrected restitution model and its n-T orbits: path, equation and stability.

The only unknown of an orbit is the phase ψ of the instant, because the velocity before the instant
is -nπ. The only equation is that for the velocity after the instant, derived in
:mod:`bouncing_ball.periodic.corrected_branch`. If the signature does not depend on the speed, as
for the linear contact, the orbits have a closed form; otherwise they are found by continuation. The
tests compare both, which checks both.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.corrected.impact import Hit, impact, meeting
from bouncing_ball.models.corrected.motion import CorrectedDynamics
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.periodic import corrected_branch as formulas
from bouncing_ball.periodic.continued_orbits import ContinuedModel
from bouncing_ball.periodic.orbit import Orbit, check_index
from bouncing_ball.periodic.stability import Side

# Errors of the tabulated signature of an elastic contact, multiplied by the ratio of flight
# time to delay.
_ELASTIC = 1e-10


class CorrectedOrbit(Orbit):
    """n-T orbits of the corrected restitution model; ``law`` is the :class:`Signature`.

    Examples
    --------
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> orbit = CorrectedOrbit.at(1, Signature(SpringDamper(np.pi, 0.0)), 0.8, np.pi / 2)
    >>> float(orbit.bounce_velocity) == np.pi - 0.5, round(float(orbit.phase) - np.pi / 2, 12)
    (True, -0.5)
    """

    dynamics = CorrectedDynamics.of

    @classmethod
    def at(cls, n: ArrayLike, law: Signature, amplitude: ArrayLike, phase: ArrayLike) -> Self:
        """The orbits with instants at the phase ψ; the velocity before an instant is -nπ."""
        launch = np.asarray(n) * np.pi
        hit = impact(law, amplitude, phase, -launch)
        delay = hit.instant.delay
        duration = hit.instant.duration
        found = cls.of(n, law, amplitude, hit.phase - delay, duration, delay - launch)
        # The cached property below would compute the same instant again.
        vars(found)["hit"] = hit
        return found

    @cached_property
    def hit(self) -> Hit:
        """The instant: its phase ψ, depth, speeds and signature."""
        start = meeting(self.law, self.amplitude, self.phase, self.impact_velocity)
        return impact(self.law, self.amplitude, *start)

    @property
    def instant(self) -> Instant:
        """The signature of the impacts at the speed v of the instant."""
        return self.hit.instant

    @property
    def after(self) -> np.ndarray:
        """Time from the instant to the release, D - t_c."""
        return self.contact_duration - self.instant.delay

    @property
    def bounce_height(self) -> np.ndarray:
        """Absolute height z_b at release, on the parabola of the flight after the instant."""
        return self.hit.height + (self.bounce_velocity + self.after / 2) * self.after

    def contact_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Height and velocity on the parabolas of the flights before and after the instant."""
        since = np.asarray(time) - self.instant.delay
        start = np.where(since < 0, self.hit.arrival, self.bounce_velocity + self.after)
        return self.hit.height + (start - since / 2) * since, start - since

    @property
    def unknowns(self) -> tuple[np.ndarray, ...]:
        """The only unknown, the phase ψ of the instant."""
        return (self.hit.phase,)

    def residual(self) -> np.ndarray:
        """Two velocity defects, shape (..., 2).

        Let w₀ = z′_b + D - t_c be the velocity with which the flight starts at the instant. The
        defects are w₀ - nπ, and the velocity after the impact minus w₀.
        """
        start = self.bounce_velocity + self.after
        level = start - np.asarray(self.n) * np.pi
        return np.stack(np.broadcast_arrays(level, self.hit.velocity - start), axis=-1)

    def jacobian(self) -> np.ndarray:
        """Jacobian of the last defect in (ψ, Λ), shape (..., 1, 2)."""
        here = self._tangent
        sine = np.sin(self.hit.phase)
        cosine = np.cos(self.hit.phase)
        gain = 1 + here.restitution
        load = here.load
        by_phase = -self.amplitude * (gain * sine + load * cosine)
        return np.stack([by_phase, gain * cosine - load * sine], axis=-1)[..., np.newaxis, :]

    @property
    def _tangent(self) -> Instant:
        """The constant signature that agrees to first order at the speed of the instant."""
        load = 1 - self.amplitude * np.sin(self.hit.phase)
        return self.instant.tangent(self.hit.speed, load)[0]

    def monodromy(self) -> np.ndarray:
        """Jacobian of the return map (φ, δ′) → (φ₁, δ′₁), shape (..., 2, 2).

        If the instant is moved by (dψ, dp), the velocity after it changes by W dψ - b dp, and its
        depth by e dv. With ``u = v - e a``, the next instant is later by s, where
        ``u s = (2πn - e)(W dψ - b dp) + e dp``. Each contact starts the time t_c(v) before its
        instant.
        """
        y = self.amplitude * np.sin(self.hit.phase)
        d_delay = self.instant.d_delay
        here = self._tangent
        velocity = np.zeros((*self.shape, 2))
        velocity[..., 0] = self.jacobian()[..., 0, 0]
        velocity[..., 1] = -here.restitution
        later = (2 * np.pi * np.asarray(self.n) - here.delay)[..., np.newaxis] * velocity
        later[..., 1] += here.delay
        later /= (self.hit.speed - here.delay * (1 - y))[..., np.newaxis]
        between = np.stack([later, velocity - later], axis=-2)
        between[..., 0, 0] += 1
        # From (ψ, p) to (φ, δ′): φ = ψ - t_c(v), δ′ = p + t_c(v) - Λ cos φ.
        to_start = np.tile(np.eye(2), (*self.shape, 1, 1))
        delay = np.stack(np.broadcast_arrays(-y * d_delay, -d_delay), axis=-1)
        to_start[..., 0, :] -= delay
        to_start[..., 1, :] += delay
        fall = self.amplitude * np.sin(self.phase)
        to_start[..., 1, :] += fall[..., np.newaxis] * to_start[..., 0, :]
        return to_start @ between @ np.linalg.inv(to_start)

    def trace_and_determinant(self) -> tuple[np.ndarray, np.ndarray]:
        """The closed forms of :mod:`bouncing_ball.periodic.corrected_branch`.

        Without dissipation the determinant is 1, and rounding errors would decide about stability.
        A determinant that equals 1 within the error of a tabulated signature is therefore set to 1.
        """
        trace, det = formulas.trace_and_determinant(
            self.n, self.instant, self.amplitude, self.hit.phase
        )
        return trace, np.where(np.abs(det - 1) < _ELASTIC, 1.0, det)

    def determinant(self) -> np.ndarray:
        """Determinant of the linearised cycle, in closed form."""
        return self.trace_and_determinant()[1]


@dataclass(frozen=True, repr=False)
class CorrectedModel(ContinuedModel):
    """A ball whose impacts are instants at the centroid of the contact force.

    Parameters
    ----------
    law : Signature
        Delay, restitution, load sensitivity and duration of the impact as functions of its speed.

    Examples
    --------
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> model = CorrectedModel.of_contact(SpringDamper.from_restitution(0.65, 10.0))
    >>> round(float(model.orbit(1, 1.0).max_height), 3)
    5.215
    """

    law: Signature

    name: ClassVar[str] = "corrected"
    orbit_type: ClassVar[type[Orbit]] = CorrectedOrbit

    @classmethod
    def of_contact(cls, contact: ContactLaw) -> "CorrectedModel":
        """The corrected model of a contact; its orbits have a closed form if the signature does not
        depend on the speed.

        Raises
        ------
        ModelError
            If the contact has no signature, as a linear one for ζ ≥ 1, or is a row of laws that
            have no table in common.
        """
        signature = Signature(contact)
        kind = ConstantCorrectedModel if signature.is_constant else CorrectedModel
        return kind(signature)

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature at impact speeds v > 0."""
        return self.law(speed)


class ConstantCorrectedModel(CorrectedModel):
    """The corrected model with a signature that does not depend on the speed, in closed form."""

    has_closed_form: ClassVar[bool] = True

    @property
    def _instant(self) -> Instant:
        return self.law(np.ones(self.shape))

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> CorrectedOrbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where there is no orbit."""
        check_index(n)
        lam = np.asarray(amplitude, dtype=float)
        psi = formulas.instant_phase(n, self._instant, lam, Side(side) is Side.STABLE)
        return CorrectedOrbit.at(n, self.law, lam, psi)

    def saddle_node(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the saddle-node, ψ = -χ; NaN where the branch has no saddle-node."""
        check_index(n)
        lam = formulas.saddle_node(n, self._instant)
        psi = formulas.saddle_node_phase(self._instant)
        return CorrectedOrbit.at(n, self.law, lam, np.where(np.isnan(lam), np.nan, psi))

    def period_doubling(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the period doubling; NaN where there is no period doubling."""
        check_index(n)
        lam, psi = formulas.period_doubling(n, self._instant)
        return CorrectedOrbit.at(n, self.law, lam, psi)
