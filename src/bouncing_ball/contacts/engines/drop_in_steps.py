r"""A drop onto a wall at rest, with gravity, as the time stepping of an engine computes it.

An engine adds gravity to the velocity in each step, ``v⁺ = v - gΔt``, before the contact acts, and
moves the ball by ``x⁺ = x + v⁺ Δt``. In contact it takes the step of its scheme
(:mod:`bouncing_ball.contacts.engines.scheme`). How high the ball rises depends on where in a step
it meets the wall, and hence on the last fraction of the height from which it is dropped.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.contacts.engines.scheme import Scheme, compensated
from bouncing_ball.models.damping import Release

# Heights of the drop within the last step of the fall, and the steps of a contact that is followed.
_SAMPLES = 257
MOST_STEPS = 20_000
"""Steps in a contact above which the continuous drop is as good."""
# A ball that has not left after so many times the duration of a contact stays.
_PATIENCE = 20
_FEW = 200


@dataclass(frozen=True)
class Rise:
    """The least and the greatest height of the rebound in m; 0 for a ball that does not leave."""

    least: float
    most: float


def drop_in_steps(
    scheme: Scheme,
    contact: Physical,
    release: Release,
    time_step: float,
    speed: float,
    gravity: float,
) -> Rise:
    """The rises of balls that arrive with a speed in m/s, at all instants within a time step in s.

    Examples
    --------
    Small steps conserve the energy of an elastic contact:

    >>> ball = Physical(1.0, 1e4, 0.0)
    >>> rise = drop_in_steps(Scheme.SEMI_IMPLICIT, ball, Release.FORCE, 1e-5, 2.0, 9.81)
    >>> abs(rise.least / (4 / 19.62) - 1) < 1e-3, abs(rise.most / (4 / 19.62) - 1) < 1e-3
    (True, True)
    """
    m, stiffness, damping = contact
    h = time_step
    g = gravity
    k = stiffness / m
    c = damping / m
    implicit = scheme is not Scheme.SEMI_IMPLICIT
    if scheme is Scheme.COMPENSATED:
        k, c = compensated(k, c, h)
    # The ball falls from rest in whole steps, and meets the wall at all places within the last.
    drop = speed * speed / (2 * g) + speed * h * np.linspace(-0.5, 0.5, _SAMPLES)
    n = np.ceil(np.sqrt(0.25 + 2 * np.maximum(drop, 0.0) / (g * h * h)) - 0.5)
    x = drop - g * h * h * n * (n + 1) / 2
    v = -g * h * n
    # A ball at exactly the level of the wall is not yet in contact.
    x = np.where(x == 0, -np.finfo(float).tiny, x)
    patience = _FEW + int(_PATIENCE * contact.contact_time(release) / h)
    for _ in range(patience):
        inside = x < 0
        if not inside.any():
            break
        free = v - g * h
        lossy = v if release.is_linear else np.minimum(v, 0.0)
        grip = k * (x + h * free) + c * free if implicit else k * x + c * lossy
        after = (free - h * k * x) / (1 + h * c + h * h * k) if implicit else free - h * grip
        pushes = (grip < 0) | release.at_surface
        after = np.where(pushes, after, free)
        v = np.where(inside, after, v)
        x = np.where(inside, x + h * after, x)
    steps = np.floor(np.maximum(v, 0.0) / (g * h))
    top = np.where(x < 0, 0.0, x + steps * h * v - g * h * h * steps * (steps + 1) / 2)
    # Relative to the drop of each ball, of which one is the drop asked for.
    rises = np.maximum(top, 0.0) / np.maximum(drop, np.finfo(float).tiny) * speed**2 / (2 * g)
    leaves = v > 0
    rises = np.where(leaves, rises, 0.0)
    return Rise(float(rises.min()), float(rises.max()))
