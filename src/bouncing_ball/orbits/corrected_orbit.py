"""n-T orbits of the corrected restitution model: path, equations and stability.

All quantities are dimensionless.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.corrected_map import (
    Hit,
    impact,
    instant_jacobian,
    meeting,
    start_jacobian,
)
from bouncing_ball.contacts.signature import Instant, Signature
from bouncing_ball.orbits import corrected_branch as formulas
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.system import OrbitSystem


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

    @property
    def release_displacement(self) -> np.ndarray:
        """δ_b at release."""
        return self.bounce_height - self.amplitude * np.sin(self.release_phase)

    def contact_path(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The two continued flights, before and after the instant."""
        since = np.asarray(time) - self.instant.delay
        start = np.where(since < 0, self.hit.arrival, self.bounce_velocity + self.after)
        return self.hit.height + (start - since / 2) * since, start - since

    def residual(self) -> np.ndarray:
        """Velocity after the impact against the flight's, and nπ, shape (..., 2)."""
        start = self.bounce_velocity + self.after
        level = start - np.asarray(self.n) * np.pi
        return np.stack(np.broadcast_arrays(self.hit.velocity - start, level), axis=-1)

    def monodromy(self) -> np.ndarray:
        """Jacobian of the return map (φ, δ′) → (φ₁, δ′₁), shape (..., 2, 2).

        Between instants, and from there to the starts of contact.
        """
        hit, period = self.hit, 2 * np.pi * np.asarray(self.n)
        to_start = start_jacobian(self.amplitude, hit)
        between = instant_jacobian(self.amplitude, hit, period, hit)
        return to_start @ between @ np.linalg.inv(to_start)

    def trace_and_determinant(self) -> tuple[np.ndarray, np.ndarray]:
        """The closed forms of :mod:`bouncing_ball.orbits.corrected_branch`."""
        return formulas.trace_and_determinant(self.n, self.instant, self.amplitude, self.hit.phase)

    def determinant(self) -> np.ndarray:
        """That of the linearised cycle, in closed form."""
        return self.trace_and_determinant()[1]


@dataclass(frozen=True)
class CorrectedSystem(OrbitSystem):
    """The equations of these orbits: velocity after the instant, and nπ.

    Unknowns (ψ, w), the phase of the instant and the velocity after it; parameter Λ.
    They have the form of :mod:`bouncing_ball.orbits.corrected_branch`;
    continued, they check both the continuation and the formula.

    Parameters
    ----------
    n : int
        Index of the family.
    law : Signature

    Examples
    --------
    >>> from bouncing_ball.contacts.signature import Signature
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> system = CorrectedSystem(1, Signature(SpringDamper(5.0, 0.0)))
    >>> [abs(round(float(x), 12)) for x in system.residual(np.array([np.pi / 2, np.pi, 1.0]))]
    [0.0, 0.0]
    """

    n: int | np.ndarray
    law: Signature

    def orbit(self, y: np.ndarray) -> CorrectedOrbit:
        """The orbits at points y of shape (..., 3)."""
        psi, after, amplitude = (y[..., k] for k in range(3))
        arrival = after - 2 * np.pi * self.n
        instant = impact(self.law, amplitude, psi, arrival).instant
        start, phase = arrival + instant.delay, psi - instant.delay
        duration = instant.duration + 0 * psi
        return CorrectedOrbit(self.n, self.law, amplitude, phase, duration, start)

    def coordinates(self, orbit: CorrectedOrbit) -> tuple[np.ndarray, ...]:
        """(ψ, w, Λ)."""
        return orbit.hit.phase, orbit.bounce_velocity + orbit.after, orbit.amplitude

    def jacobian(self, y: np.ndarray) -> np.ndarray:
        """Exact Jacobian of the residual, shape (..., 2, 3)."""
        psi, amplitude = y[..., 0], y[..., 2]
        sine, cosine = np.sin(psi), np.cos(psi)
        hit = impact(self.law, amplitude, psi, y[..., 1] - 2 * np.pi * self.n)
        here, _ = hit.instant.tangent(hit.speed, 1 - amplitude * sine)
        r, load = here.restitution, here.load
        out = np.zeros((*y.shape[:-1], 2, 3))
        out[..., 0, 0] = -amplitude * ((1 + r) * sine + load * cosine)
        out[..., 0, 1] = -r - 1
        out[..., 0, 2] = (1 + r) * cosine - load * sine
        out[..., 1, 1] = 1
        return out
