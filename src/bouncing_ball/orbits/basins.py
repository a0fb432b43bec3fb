"""Which orbit a ball ends on, from the Poincaré map of any model.

A stable orbit is left alone once a ball is near enough. How near is found beforehand: in the
coordinates in which the linearised map shrinks every vector, the map itself
shrinks a whole disk about the orbit. A ball in this *trap* can only go to the
orbit, and needs no further impacts.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit

PERMANENT = -1
"""Destination of a ball that stays on the table for ever."""
ELSEWHERE = -2
"""Destination of a ball that is in no trap after all impacts."""

# Directions in which a circle is tried, and radii, from the greatest down to one in which
# the map is linear, at steps of a quarter.
_DIRECTIONS = 256
_RADII = 2.0 ** np.arange(-12.0, 2.0, 0.25)


@dataclass(frozen=True)
class Trap:
    """A disk about a stable orbit that the map shrinks.

    Parameters
    ----------
    phase, velocity : float
        φ and δ′ of the orbit.
    frame : ndarray
        Turns a deviation (φ, δ′) into coordinates that the linearised map shrinks,
        complex, shape (2, 2).
    radius : float
        Of the disk in these coordinates; 0 if no disk was found.
    """

    phase: float
    velocity: float
    frame: np.ndarray
    radius: float

    def distance(self, phase: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """How far states are from the orbit, in its coordinates."""
        turned, faster = reduce_angle(phase - self.phase), velocity - self.velocity
        a, b = (abs(row[0] * turned + row[1] * faster) for row in self.frame)
        return np.hypot(a, b)


def trap(model: ImpactModel, orbit: Orbit) -> Trap:
    """The largest disk that shrinks, and all smaller ones with it, by its boundary.

    The map is continuous as long as no ball grazes, and a disk whose boundary goes inside
    goes inside as a whole.

    Examples
    --------
    >>> from bouncing_ball.orbits.restitution_model import RestitutionModel
    >>> model = RestitutionModel(0.5)
    >>> disk = trap(model, model.require_orbit(1, 1.2))
    >>> disk.radius > 0, bool(disk.distance(disk.phase + 2 * np.pi, disk.velocity) < 1e-12)
    (True, True)
    """
    _, vectors = np.linalg.eig(orbit.monodromy())
    frame = np.linalg.inv(vectors)
    phase, velocity = float(orbit.phase), float(orbit.relative_impact_velocity)
    metric = np.real(frame.conj().T @ frame)
    angle = np.linspace(0, 2 * np.pi, _DIRECTIONS, endpoint=False)
    circle = np.linalg.solve(np.linalg.cholesky(metric).T, [np.cos(angle), np.sin(angle)])
    radii = _RADII / np.abs(circle).max()
    turned, faster = circle[:, np.newaxis, :] * radii[:, np.newaxis]
    falling = velocity + faster < 0
    probe = Trap(phase, velocity, frame, 0.0)
    after = model.cycle(orbit.amplitude, phase + turned, np.where(falling, velocity + faster, -1.0))
    inside = probe.distance(after.phase, after.relative_velocity) < radii[:, np.newaxis]
    shrinks = np.logical_and.accumulate((falling & inside).all(axis=1))
    radius = radii[shrinks.sum() - 1] if shrinks.any() else 0.0
    return Trap(phase, velocity, frame, float(radius))


class Destinations(NamedTuple):
    """Where balls end: index of the orbit, :data:`PERMANENT` or :data:`ELSEWHERE`, with their
    state (φ, δ′) when that was known, NaN in permanent contact."""

    orbit: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray


def destinations(
    model: ImpactModel,
    amplitude: float,
    orbits: Sequence[Orbit],
    phase: np.ndarray,
    velocity: np.ndarray,
    impacts: int,
) -> Destinations:
    """Follow balls from impacts (φ, δ′ < 0) until they are in the trap of an orbit.

    Parameters
    ----------
    model : ImpactModel
    amplitude : float
        Λ.
    orbits : sequence of Orbit
        The stable ones at this Λ.
    phase, velocity : ndarray, shape (balls,)
        Starts.
    impacts : int
        After which a ball is given up.
    """
    traps = [trap(model, orbit) for orbit in orbits]
    found = np.full(phase.shape, ELSEWHERE)
    last = np.array([phase, velocity], dtype=float)
    alive = np.arange(phase.size)
    for _ in range(impacts):
        here = last[:, alive]
        for index, disk in enumerate(traps):
            found[alive[disk.distance(*here) < disk.radius]] = index
        alive = alive[found[alive] == ELSEWHERE]
        if not alive.size:
            break
        after = model.cycle(amplitude, *last[:, alive])
        last[:, alive] = after.phase, after.relative_velocity
        stays = ~np.isfinite(after.phase)
        found[alive[stays]] = PERMANENT
        alive = alive[~stays]
    return Destinations(found, *last)
