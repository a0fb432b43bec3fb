"""n-T orbits of the corrected restitution model: path, equation and stability.

The unknown is the phase ψ of the instant: the velocity before it is -nπ. What is left is the
velocity after it, the equation of :mod:`bouncing_ball.orbits.corrected_branch`; continued, it
checks both the continuation and the formula. All quantities are dimensionless.
"""

from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.corrected_map import Hit, impact, meeting
from bouncing_ball.contacts.signature import Instant, Signature
from bouncing_ball.orbits import corrected_branch as formulas
from bouncing_ball.orbits.orbit import Orbit

# Errors of the signature of an elastic contact, grown by the flight over the delay.
_ELASTIC = 1e-10


class CorrectedOrbit(Orbit):
    """n-T orbits of the corrected restitution model; ``law`` is the :class:`Signature`.

    Examples
    --------
    >>> from bouncing_ball.contacts.signature import Signature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> orbit = CorrectedOrbit.at(1, Signature(SpringDamper(np.pi, 0.0)), 0.8, np.pi / 2)
    >>> float(orbit.bounce_velocity) == np.pi - 0.5, round(float(orbit.phase) - np.pi / 2, 12)
    (True, -0.5)
    """

    @classmethod
    def at(cls, n: ArrayLike, law: Signature, amplitude: ArrayLike, phase: ArrayLike) -> Self:
        """The orbits with instants at the phase ψ, where the velocity before is -nπ."""
        launch = np.asarray(n) * np.pi
        hit = impact(law, amplitude, phase, -launch)
        delay, duration = hit.instant.delay, hit.instant.duration
        found = cls.of(n, law, amplitude, hit.phase - delay, duration, delay - launch)
        # Known already: nobody needs to find it again.
        vars(found)["hit"] = hit
        return found

    @cached_property
    def hit(self) -> Hit:
        """The instant: phase ψ, depth, speeds."""
        start = meeting(self.law, self.amplitude, self.phase, self.impact_velocity)
        return impact(self.law, self.amplitude, *start)

    @property
    def instant(self) -> Instant:
        """The signature of the impacts, at the speed of the instant."""
        return self.hit.instant

    @property
    def after(self) -> np.ndarray:
        """Time from the instant to the release, D - t_c."""
        return self.contact_duration - self.instant.delay

    @property
    def bounce_height(self) -> np.ndarray:
        """Absolute height z_b of the ball at release, by the flight from the instant."""
        return self.hit.height + (self.bounce_velocity + self.after / 2) * self.after

    def contact_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The two continued flights, before and after the instant."""
        since = np.asarray(time) - self.instant.delay
        start = np.where(since < 0, self.hit.arrival, self.bounce_velocity + self.after)
        return self.hit.height + (start - since / 2) * since, start - since

    @property
    def unknowns(self) -> tuple[np.ndarray, ...]:
        """ψ."""
        return (self.hit.phase,)

    def residual(self) -> np.ndarray:
        """nπ against the flight's velocity after the impact, and that of the impact against it.

        Shape (..., 2).
        """
        start = self.bounce_velocity + self.after
        level = start - np.asarray(self.n) * np.pi
        return np.stack(np.broadcast_arrays(level, self.hit.velocity - start), axis=-1)

    def jacobian(self) -> np.ndarray:
        """Jacobian of the last defect in (ψ, Λ), shape (..., 1, 2)."""
        here, sine, cosine = self._tangent, np.sin(self.hit.phase), np.cos(self.hit.phase)
        gain, load = 1 + here.restitution, here.load
        by_phase = -self.amplitude * (gain * sine + load * cosine)
        return np.stack([by_phase, gain * cosine - load * sine], axis=-1)[..., np.newaxis, :]

    @property
    def _tangent(self) -> Instant:
        """The constant signature that changes alike next to the instant."""
        load = 1 - self.amplitude * np.sin(self.hit.phase)
        return self.instant.tangent(self.hit.speed, load)[0]

    def monodromy(self) -> np.ndarray:
        """Jacobian of the return map (φ, δ′) → (φ₁, δ′₁), shape (..., 2, 2).

        An instant moved by (dψ, dp) changes the velocity after it by W dψ - b dp, and its
        depth by e dv; with ``u = v - e a`` the next one is later by
        ``u s = (2πn - e)(W dψ - b dp) + e dp``. The starts of contact are t_c(v) before.
        """
        y, d_delay = self.amplitude * np.sin(self.hit.phase), self.instant.d_delay
        here, velocity = self._tangent, np.zeros((*self.shape, 2))
        velocity[..., 0], velocity[..., 1] = self.jacobian()[..., 0, 0], -here.restitution
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
        """The closed forms of :mod:`bouncing_ball.orbits.corrected_branch`.

        A determinant that a tabulated signature does not tell from 1 is 1: without
        dissipation it is, and rounding would decide between stable and not.
        """
        place = self.amplitude, self.hit.phase
        trace, det = formulas.trace_and_determinant(self.n, self.instant, *place)
        return trace, np.where(np.abs(det - 1) < _ELASTIC, 1.0, det)

    def determinant(self) -> np.ndarray:
        """That of the linearised cycle, in closed form."""
        return self.trace_and_determinant()[1]
