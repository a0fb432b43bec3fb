"""Greatest height of an orbit whose contact may lift the ball higher than it flies."""

from typing import Any

import numpy as np

from bouncing_ball.motion.ensembles import blocks

# Samples of a contact among which its highest point is looked for, and Newton
# steps from there.
_SAMPLES = 33
_REFINEMENTS = 4
# Orbits whose samples are in memory at once.
_BLOCK = 1024


def highest(orbit: Any) -> np.ndarray:
    """Greatest absolute height over the cycle of orbits that know their contact's motion.

    In flight, if that reaches Λ: in contact the ball stays below the table.
    Else a long contact may lift it higher with the table.
    """
    top = np.asarray(orbit.flight_top)
    low = np.broadcast_to(top < orbit.amplitude, orbit.shape)
    if not np.any(low):
        return top
    if not orbit.shape:
        return np.maximum(top, _contact_top(orbit))
    top, lifted = np.array(np.broadcast_to(top, orbit.shape)), orbit[low]
    # The samples of all at once would be gigabytes.
    parts = [_contact_top(lifted[part]) for part in blocks(lifted.size, _BLOCK)]
    top[low] = np.maximum(top[low], np.concatenate(parts))
    return top


def _contact_top(orbit: Any) -> np.ndarray:
    """Greatest height in contact: its highest sample, refined by Newton's method."""
    share = np.linspace(0.0, 1.0, _SAMPLES)
    share = share.reshape(-1, *(1,) * np.ndim(orbit.contact_duration))
    height, _ = orbit.contact_path(share * orbit.contact_duration)
    at = np.argmax(np.where(np.isnan(height), -np.inf, height), axis=0)
    step = orbit.contact_duration / (_SAMPLES - 1)
    time = centre = at * step
    low = np.maximum(centre - step, 0.0)
    high = np.minimum(centre + step, orbit.contact_duration)
    for _ in range(_REFINEMENTS):
        _, velocity = orbit.contact_path(time)
        slope = orbit.contact_acceleration(time)
        moved = np.where(slope < 0, -velocity / np.where(slope < 0, slope, -1.0), 0.0)
        time = np.clip(time + moved, low, high)
    return orbit.contact_path(time)[0]
