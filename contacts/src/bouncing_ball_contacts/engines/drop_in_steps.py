r"""A drop onto a wall at rest, with gravity, as the time stepping of an engine computes it.

How high the ball rises depends on where in a step it meets the wall, and hence on the last fraction
of the height from which it is dropped.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball_contacts.engines.steps import Step, patience, until_outside

# Heights of the drop within the last step of the fall.
_SAMPLES = 257
MOST_STEPS = 20_000
"""Steps in a contact above which the continuous drop is as good."""


@dataclass(frozen=True)
class ReboundHeights:
    """The least and the greatest height of the rebound in m; 0 for a ball that does not leave."""

    least: float
    most: float


def drop_in_steps(step: Step, speed: float, gravity: float, contact_time: float) -> ReboundHeights:
    """The rises of balls that arrive with a speed in m/s, at all instants within a time step in s.

    ``contact_time`` is that of a free impact in s.

    Examples
    --------
    Small steps conserve the energy of an elastic contact:

    >>> from bouncing_ball_contacts.engines.scheme import Scheme
    >>> from bouncing_ball_contacts.engines.steps import LinearStep
    >>> from bouncing_ball_beyond.models.damping import Release
    >>> step = LinearStep.of(Scheme.SEMI_IMPLICIT, 1e4, 0.0, Release.FORCE, 1e-5)
    >>> rise = drop_in_steps(step, 2.0, 9.81, 0.0314)
    >>> abs(rise.least / (4 / 19.62) - 1) < 1e-3, abs(rise.most / (4 / 19.62) - 1) < 1e-3
    (True, True)
    """
    h = step.size
    g = gravity
    # The ball falls from rest in whole steps, and meets the wall at all places within the last.
    drop = speed * speed / (2 * g) + speed * h * np.linspace(-0.5, 0.5, _SAMPLES)
    n = np.ceil(np.sqrt(0.25 + 2 * np.maximum(drop, 0.0) / (g * h * h)) - 0.5)
    x = drop - g * h * h * n * (n + 1) / 2
    # A ball at exactly the level of the wall is not yet in contact.
    x = np.where(x == 0, -np.finfo(float).tiny, x)
    x, v = until_outside(step, x, -g * h * n, patience(contact_time / h), g)
    steps = np.floor(np.maximum(v, 0.0) / (g * h))
    top = np.where(x < 0, 0.0, x + steps * h * v - g * h * h * steps * (steps + 1) / 2)
    # Relative to the drop of each ball, of which one is the drop asked for.
    rises = np.maximum(top, 0.0) / np.maximum(drop, np.finfo(float).tiny) * speed**2 / (2 * g)
    rises = np.where(v > 0, rises, 0.0)
    return ReboundHeights(float(rises.min()), float(rises.max()))
