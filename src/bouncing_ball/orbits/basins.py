"""The orbit on which a ball ends, from the Poincaré map of any model.

A ball that is near enough to a stable orbit approaches it, so that its further impacts need
not be simulated. How near is found beforehand: in the coordinates in which the linearised map
shrinks every vector, the map itself shrinks a disk about the orbit. A ball in this *trap*
can only approach the orbit.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit

PERMANENT = -1
"""Destination of a ball that stays on the table."""
ELSEWHERE = -2
"""Destination of a ball that is in no trap after the last impact."""

# Directions in which a circle is sampled, and radii in steps of a quarter of an octave, from
# one at which the map is linear up to the largest.
_DIRECTIONS = 256
_RADII = 2.0 ** np.arange(-12.0, 2.0, 0.25)


@dataclass(frozen=True)
class Trap:
    """A disk about a stable orbit that the Poincaré map shrinks.

    Parameters
    ----------
    phase, velocity : float
        φ and δ′ of the orbit.
    frame : ndarray
        Matrix from a deviation (φ, δ′) to coordinates in which the linearised map shrinks
        distances; complex, shape (2, 2).
    radius : float
        Radius of the disk in these coordinates; 0 if no disk was found.
    """

    phase: float
    velocity: float
    frame: np.ndarray
    radius: float

    def distance(self, phase: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Distance of states (φ, δ′) from the orbit in its coordinates, of the states' shape."""
        turned, faster = reduce_angle(phase - self.phase), velocity - self.velocity
        a, b = (abs(row[0] * turned + row[1] * faster) for row in self.frame)
        return np.hypot(a, b)


def trap(model: ImpactModel, orbit: Orbit) -> Trap:
    """The largest disk that shrinks together with all smaller ones, judged by its boundary.

    The map is continuous as long as no ball grazes, so that a disk whose boundary is mapped
    inside is mapped inside. The boundary is sampled in 256 directions.

    Parameters
    ----------
    model : ImpactModel
    orbit : Orbit
        A single stable one.

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
    """Where balls end, with shape (balls,) each.

    ``orbit`` is the index of the orbit, :data:`PERMANENT` or :data:`ELSEWHERE`; ``phase`` and
    ``velocity`` are the last state (φ, δ′), NaN in permanent contact.
    """

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
        A single one.
    amplitude : float
        Λ.
    orbits : sequence of Orbit
        The stable orbits at this Λ, each a single one.
    phase, velocity : ndarray, shape (balls,)
        φ and δ′ of the first impacts.
    impacts : int
        Number of impacts after which a ball counts as :data:`ELSEWHERE`.

    Examples
    --------
    Below Λ = 1 a ball of the restitution model comes to rest where it has no orbit:

    >>> from bouncing_ball.orbits.restitution_model import RestitutionModel
    >>> states = np.zeros(2), np.array([-1.0, -3.0])
    >>> destinations(RestitutionModel(0.5), 0.5, [], *states, 100).orbit.tolist()
    [-1, -1]
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
