"""Whether an algebraic orbit is one of the ball.

The equations of an n-T orbit look at its start, release and landing only. It
counts if nothing happens in between: the ball stays below the table's level
in contact (or the table always pushes, with the force release) and above it
in flight. The *margin* is the distance from the nearest such event, negative
once it is passed; its zeros are grazing orbits.
"""

import numpy as np

from bouncing_ball.models.contact import Release, contact_flow
from bouncing_ball.models.flight import clearance
from bouncing_ball.orbits.contact_orbit import ContactOrbit

# Samples of a contact per half period of the faster of its two oscillations,
# contact and table, between which the extrema are then located by bisection.
_SAMPLES_PER_HALF_PERIOD = 16
_BISECTIONS = 54


def flight_margin(orbit: ContactOrbit) -> np.ndarray:
    """Smallest interior minimum of the gap in flight, infinite without one.

    With the force release the flight starts below the table's level; the part
    until the ball has come up is checked by :func:`rise_margin`.
    """
    lam = orbit.amplitude
    return clearance(
        orbit.flight_time,
        orbit.phase + orbit.duration,
        orbit.release_displacement,
        orbit.relative_bounce_velocity,
        lam,
    )


def restitution_margin(n, amplitude, phase, velocity) -> np.ndarray:
    """Smallest interior minimum of the gap, restitution model's n-T orbit.

    Examples
    --------
    >>> float(restitution_margin(1, 0.8, 1.2, np.pi))
    inf
    """
    relative = np.asarray(velocity) - amplitude * np.cos(phase)
    return clearance(2 * np.pi * np.asarray(n), phase, 0.0, relative, amplitude)


def _contact_signal(orbit: ContactOrbit, time: np.ndarray):
    """What ends the contact when it reaches zero from below, and its rate."""
    omega, zeta = orbit.contact.frequency_ratio, orbit.contact.damping_ratio
    u, lam = orbit.relative_impact_velocity, orbit.amplitude
    flow = contact_flow(time, 0.0, u, orbit.phase, lam, omega, zeta)
    if orbit.contact.release is Release.DISPLACEMENT:
        return flow.displacement, flow.velocity
    return (
        omega * flow.displacement + 2 * zeta * flow.velocity,
        omega * flow.velocity + 2 * zeta * flow.acceleration,
    )


def contact_margin(orbit: ContactOrbit) -> np.ndarray:
    """Minus the largest interior maximum of the releasing signal, scaled to δ.

    The signal is δ, or δ + 2ζδ′/ϖ with the force release; infinite where it
    has no interior maximum, as in every short contact.
    """
    omega = np.asarray(orbit.contact.frequency_ratio)
    angle = orbit.duration * np.maximum(omega, 1)
    longest = np.max(np.where(np.isfinite(angle), angle, 0.0))
    samples = max(int(np.ceil(longest / np.pi * _SAMPLES_PER_HALF_PERIOD)), 16)
    highest = np.full(np.shape(orbit.duration), -np.inf)
    scale = 1 / omega if orbit.contact.release is Release.FORCE else 1.0
    time = np.zeros_like(orbit.duration)
    rate = _contact_signal(orbit, time)[1]
    for k in range(1, samples + 1):
        before, rate_before = time, rate
        time = orbit.duration * (k / samples)
        rate = _contact_signal(orbit, time)[1]
        peak = (rate_before > 0) & (rate <= 0)
        if not np.any(peak):
            continue
        left, right = before, time
        for _ in range(_BISECTIONS):
            middle = (left + right) / 2
            rising = _contact_signal(orbit, middle)[1] > 0
            left, right = np.where(rising, middle, left), np.where(rising, right, middle)
        value = _contact_signal(orbit, left)[0] * scale
        highest = np.where(peak, np.maximum(highest, value), highest)
    return -highest


def rise_margin(orbit: ContactOrbit) -> np.ndarray:
    """Lower bound of the rate at which a released ball clears the contact.

    With the force release the ball leaves below the table's level, and the
    contact would resume if the signal ``S = δ + 2ζδ′/ϖ`` fell back to zero
    before δ does. In flight δ″ ≥ -(1 + Λ), which bounds the time s of the rise,
    and ``S ≥ S′(0) s - K s²/2`` with K = 1 + Λ + 2ζΛ/ϖ: positive while
    ``S′(0) - K s/2`` is. The bound errs on the side of inadmissible. Infinite
    for the displacement release, which has no such rise.
    """
    if orbit.contact.release is Release.DISPLACEMENT:
        return np.full(np.shape(orbit.duration), np.inf)
    lag = 2 * orbit.contact.damping_ratio / orbit.contact.frequency_ratio
    lam, velocity = orbit.amplitude, orbit.relative_bounce_velocity
    depth, fall = -orbit.release_displacement, 1 + lam
    inside = velocity * velocity - 2 * fall * depth
    rise = 2 * depth / (velocity + np.sqrt(np.where(inside >= 0, inside, np.nan)))
    weight = lam * np.sin(orbit.phase + orbit.duration) - 1
    bound = velocity + lag * weight - (fall + lag * lam) * rise / 2
    return np.where((inside >= 0) & (velocity > 0), bound, -np.inf)


def margin(orbit: ContactOrbit) -> np.ndarray:
    """Distance from the nearest unaccounted event; negative: inadmissible."""
    return np.minimum(np.minimum(flight_margin(orbit), contact_margin(orbit)), rise_margin(orbit))


def is_admissible(orbit: ContactOrbit) -> np.ndarray:
    """Whether the orbit is one of the ball; false where there is none."""
    closing = orbit.relative_impact_velocity < 0
    return closing & (orbit.duration > 0) & (orbit.flight_time > 0) & (margin(orbit) > 0)
