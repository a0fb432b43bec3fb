"""A law of the impact of one's own: restitution that falls with the speed.

Plastic spheres keep ``r = (c/v)^¼`` of a speed v above the yield speed c, and
all of a lower one (K. L. Johnson, Contact Mechanics, 1985, §11.5). What the
interface of :mod:`bouncing_ball.orbits.model` asks of a model is here, and
no more: a law, its orbits, their equations, and the model.

An n-T orbit has ``z′_i = -nπ`` whatever the law, so that with v = nπ + Λ cos φ the
law ``2πn - v = f(v)``, f(v) = r v, is an equation for v alone.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bouncing_ball.contacts.batch import Batch
from bouncing_ball.continuation.events import Event
from bouncing_ball.motion.restitution import section_cycle, simulate
from bouncing_ball.motion.sequence import ImpactSequence
from bouncing_ball.orbits.model import Absence, ImpactModel, Side
from bouncing_ball.orbits.orbit import Orbit, check_index
from bouncing_ball.orbits.stability import period_doubling_function, saddle_node_function

# Newton's method for v is quadratic: from a start that is a few times v to rounding.
_ITERATIONS = 12


@dataclass(frozen=True, repr=False)
class PlasticImpact(Batch):
    """r(v) of the impact, and the derivative of f(v) = r v."""

    yield_speed: float | np.ndarray

    def restitution(self, speed):
        return np.minimum(1.0, (self.yield_speed / speed) ** 0.25)

    def slope(self, speed):
        return np.where(speed > self.yield_speed, 0.75, 1.0) * self.restitution(speed)

    def speed(self, n):
        """v of the n-T orbits: w⁴ + c^¼ w³ = 2πn for w = v^¼, if v > c."""
        period, c = 2 * np.pi * np.asarray(n, dtype=float), np.asarray(self.yield_speed) ** 0.25
        w = period**0.25 + 0 * c
        for _ in range(_ITERATIONS):
            w = w - (w**4 + c * w**3 - period) / (4 * w**3 + 3 * c * w**2)
        return np.where(w > c, w**4, period / 2)


class PlasticOrbit(Orbit):
    """n-T orbits; ``law`` is a :class:`PlasticImpact`."""

    @property
    def speed(self):
        return -self.relative_impact_velocity

    def residual(self):
        left = self.relative_bounce_velocity - self.law.restitution(self.speed) * self.speed
        landed = self.flight_time * (self.bounce_velocity + self.impact_velocity) / 2
        return np.stack(np.broadcast_arrays(landed, left), axis=-1)

    def contact_jacobian(self):
        jacobian = np.zeros((*self.shape, 3, 2))
        jacobian[..., 2, 1] = -self.law.slope(self.speed)
        return jacobian

    def determinant(self):
        # f′ at the impact; r is what the flight from one level to the same gives.
        return self.law.slope(self.speed) * self.law.restitution(self.speed)

    def cycle(self, phase, relative_velocity):
        r = self.law.restitution(-np.asarray(relative_velocity))
        return section_cycle(r, self.amplitude, phase, relative_velocity)


@dataclass(frozen=True)
class PlasticSystem:
    """y = (φ, z′_b, Λ)."""

    n: int | np.ndarray
    law: PlasticImpact

    def orbit(self, y):
        phase, after, amplitude = (y[..., k] for k in range(3))
        impact = after - 2 * np.pi * self.n
        return PlasticOrbit(self.n, self.law, amplitude, phase, 0 * phase, impact)

    def point(self, orbit):
        parts = orbit.phase, orbit.bounce_velocity, orbit.amplitude
        return np.stack(np.broadcast_arrays(*parts), axis=-1)

    def residual(self, y):
        return self.orbit(y).residual()

    def jacobian(self, y):
        phase, amplitude, slope = y[..., 0], y[..., 2], self.law.slope(self.orbit(y).speed)
        out = np.zeros((*y.shape[:-1], 2, 3))
        out[..., 0, 1] = 2 * np.pi * self.n
        out[..., 1, 0] = (1 + slope) * amplitude * np.sin(phase)
        out[..., 1, 1] = 1 + slope
        out[..., 1, 2] = -(1 + slope) * np.cos(phase)
        return out

    def events(self):
        tests = {"saddle-node": saddle_node_function, "period doubling": period_doubling_function}
        return tuple(
            Event(name, lambda y, test=test: test(*self.orbit(y).trace_and_determinant()))
            for name, test in tests.items()
        )


@dataclass(frozen=True, repr=False)
class PlasticModel(ImpactModel):
    """A ball whose impacts are instants with restitution (c/v)^¼."""

    law: PlasticImpact

    name: ClassVar[str] = "plastic"
    orbit_type: ClassVar[type[Orbit]] = PlasticOrbit

    @property
    def label(self):
        return f"c = {float(self.law.yield_speed):g}"

    def _level(self, n):
        """Λ cos φ of the n-T orbits: Λ of the saddle-node."""
        check_index(n)
        return self.law.speed(n) - np.pi * np.asarray(n)

    def orbit(self, n, amplitude, side=Side.STABLE):
        level, lam = self._level(n), np.asarray(amplitude, dtype=float)
        phase = np.arccos(np.where(lam >= level, level / np.maximum(lam, level), np.nan))
        return self.orbit_of(n, lam, phase if side == Side.STABLE else -phase)

    def orbits(self, n, amplitude):
        phases = [self.orbit(n, amplitude, side).phase for side in Side]
        there = np.unique([phase for phase in phases if np.isfinite(phase)])[::-1]
        return self.orbit_of(n, np.full_like(there, amplitude), there)

    def absence(self, n, amplitude, side=Side.STABLE):
        missing = np.asarray(amplitude) < self._level(n)
        return np.where(missing, Absence.BELOW_SADDLE_NODE, Absence.NONE)

    def saddle_node(self, n):
        return self.orbit_of(n, self._level(n), 0.0)

    def period_doubling(self, n):
        # 1 + tr + det = 0, with the trace 1 + r f′ - (1 + r)(1 + f′) Λ sin φ.
        level, speed = self._level(n), self.law.speed(n)
        r, slope = self.law.restitution(speed), self.law.slope(speed)
        lift = 2 * (1 + r * slope) / ((1 + r) * (1 + slope))
        return self.orbit_of(n, np.hypot(level, lift), np.arctan2(lift, level))

    def nearest(self, orbit):
        lift = orbit.amplitude * np.sin(orbit.phase)
        level = self._level(orbit.n)
        return self.orbit_of(orbit.n, np.hypot(level, lift), np.arctan2(lift, level))

    def system(self, n):
        return PlasticSystem(n, self.law)

    def cycle(self, amplitude, phase, relative_velocity):
        return self.orbit_of(1, amplitude, phase).cycle(phase, relative_velocity)

    def simulate(self, amplitude, phase, velocity, impacts):
        """Impact by impact: each has its own r."""
        lam, phase = np.asarray(amplitude, dtype=float), np.asarray(phase, dtype=float)
        relative, time, rows = velocity - lam * np.cos(phase), 0.0 * phase, []
        for _ in range(impacts):
            r = self.law.restitution(-relative)
            rows.append(simulate(r, lam, phase, lam * np.cos(phase) - r * relative, 1))
            rows[-1].time[:] = time
            landed = self.cycle(lam, phase, relative)
            phase, relative, time = landed.phase, landed.relative_velocity, time + landed.time
        names = ("time", "phase", "displacement", "relative_velocity", "contact_duration")
        names += ("release_displacement", "relative_release_velocity")
        joined = {name: np.concatenate([getattr(row, name) for row in rows]) for name in names}
        return ImpactSequence(lam, None, status=rows[-1].status, **joined)

    def permanent_contact_threshold(self):
        """As for any instant: below Λ = 1 the table never falls faster than the ball."""
        return np.ones(self.shape)
