"""Whether an algebraic orbit is one of the ball.

The equations of an n-T orbit look at its start, release and landing only. It
counts if nothing happens in between: no earlier release in contact, no
earlier landing in flight. The event-driven simulation decides, as its first
events are certified not to be preceded by others: an admissible orbit is a
fixed point of its return map. The limits of admissibility are grazing orbits.
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.impacts.spring_damper import Contact, Release, contact_flow
from bouncing_ball.motion.contacts import contact_cycle
from bouncing_ball.motion.gap import clearance
from bouncing_ball.orbits.contact_orbit import ContactOrbit

# An event that the equations do not know of shifts the next impact by a good
# part of a period; rounding, amplified by one unstable cycle, by far less.
_SAME = 1e-6
# Near the undamped resonance the simulation has no steady part to work with;
# the orbit is then sampled. Same measure as the simulation's own limit.
_RESONANCE = 1e-4
_SAMPLES = 4000


def restitution_is_admissible(n: ArrayLike, amplitude: ArrayLike, phase: ArrayLike) -> np.ndarray:
    """Whether the ball of the restitution model's n-T orbit stays above the table.

    Examples
    --------
    Over a table that accelerates less than gravity nothing can happen:

    >>> bool(restitution_is_admissible(1, 0.8, 1.2))
    True
    """
    n, lam, phase = np.broadcast_arrays(*(np.asarray(x, float) for x in (n, amplitude, phase)))
    velocity = n * np.pi - lam * np.cos(phase)
    return (velocity > 0) & (clearance(2 * np.pi * n, phase, 0.0, velocity, lam) > 0)


def _resonant(contact: Contact, shape) -> np.ndarray:
    omega, zeta = np.asarray(contact.frequency_ratio), np.asarray(contact.damping_ratio)
    resonance = np.hypot((omega - 1) * (omega + 1), 2 * zeta * omega) < 2 * _RESONANCE
    return np.broadcast_to(resonance, shape)


def _sampled(orbit: ContactOrbit) -> bool:
    """The same for one orbit, from samples."""
    share = np.linspace(0.0, 1.0, _SAMPLES)[1:-1]
    omega, zeta = orbit.contact.frequency_ratio, orbit.contact.damping_ratio
    u, lam = orbit.relative_impact_velocity, orbit.amplitude
    flow = contact_flow(share * orbit.duration, 0.0, u, orbit.phase, lam, omega, zeta)
    touching = flow.displacement
    if orbit.contact.release is Release.FORCE:
        touching = touching + 2 * zeta / omega * flow.velocity
    time = orbit.duration + share * orbit.flight_time
    gap = orbit.flight_path(time)[0] - lam * np.sin(orbit.phase + time)
    return bool(np.all(touching < 0) and np.all(gap > 0))


def is_admissible(orbit: ContactOrbit) -> np.ndarray:
    """Whether each orbit is one of the ball; false where there is none.

    Examples
    --------
    >>> from bouncing_ball.orbits.limits import Side, orbit_at
    >>> contact = Contact(10.0, 0.05)
    >>> bool(is_admissible(orbit_at(contact, 1, 1.0)))
    True
    >>> bool(is_admissible(orbit_at(contact, 1, 2.3, Side.UNSTABLE)))
    False
    """
    u = orbit.relative_impact_velocity
    shape = np.shape(u)
    contact = orbit.contact
    possible = (u < 0) & (orbit.duration > 0) & (orbit.flight_time > 0)
    resonant = _resonant(contact, shape)
    admissible = np.zeros(shape, dtype=bool)
    chosen = possible & ~resonant

    def at(value, which):
        return np.broadcast_to(value, shape)[which]

    if np.any(chosen):
        part = Contact(
            at(contact.frequency_ratio, chosen), at(contact.damping_ratio, chosen), contact.release
        )
        cycle = contact_cycle(
            part, at(orbit.amplitude, chosen), at(orbit.phase, chosen), at(u, chosen)
        )
        period = 2 * np.pi * at(orbit.n, chosen)
        returned = np.abs(cycle.relative_velocity / at(u, chosen) - 1) < _SAME
        same = np.abs(cycle.time - period) < _SAME
        admissible[chosen] = same & returned & (cycle.displacement == 0)
    for index in zip(*np.nonzero(possible & resonant), strict=True) if shape else ():
        admissible[index] = _sampled(_one(orbit, index))
    if not shape and possible and resonant:
        return np.array(_sampled(orbit))
    return admissible


def _one(orbit: ContactOrbit, index: tuple) -> ContactOrbit:
    """One element of an array of orbits."""
    shape = np.shape(orbit.relative_impact_velocity)

    def at(value):
        return np.broadcast_to(value, shape)[index]

    c = orbit.contact
    return ContactOrbit(
        at(orbit.n),
        Contact(at(c.frequency_ratio), at(c.damping_ratio), c.release),
        at(orbit.amplitude),
        at(orbit.phase),
        at(orbit.duration),
        at(orbit.impact_velocity),
    )
