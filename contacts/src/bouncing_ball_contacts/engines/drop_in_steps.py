r"""A drop onto a wall at rest, with gravity, as the time stepping of an engine computes it.

How high the ball rises, how deep it sinks in and how hard it is pushed depend on where in a step it
meets the wall, and hence on the last fraction of the height from which it is dropped.

An engine adds gravity to the velocity, and moves the ball with the result. From rest a ball has
fallen ``g h² n(n + 1)/2`` after n steps. With velocity Verlet, whose velocities are those of half
steps, the first step is half as fast, and the fall is the exact one, ``g h² n²/2``.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bouncing_ball_contacts.engines.steps import Step, patience, steps_inside, until_outside

# Heights of the drop within the last step of the fall.
_SAMPLES = 257
_LEAST = 0.01
MOST_STEPS = 20_000
"""Steps in a contact above which the continuous drop is as good."""


class Range(NamedTuple):
    """The least and the greatest value over the instants within a step."""

    least: float
    most: float

    @classmethod
    def of(cls, values: np.ndarray) -> "Range":
        return cls(float(values.min()), float(values.max()))


@dataclass(frozen=True)
class DropInSteps:
    """A ball that is dropped in an engine, in SI units; 0 m is the rise of one that does not leave.

    ``rise``, ``compression`` and ``peak_force`` are those of the first bounce, and
    ``depth_at_rest`` is that of the ball that has come to rest, None if the steps of a lasting
    contact grow, so that none does. ``restitution`` is the mean of
    √(h′/h), and ``error`` its greatest difference from the r that was asked for.
    """

    height: float
    rise: Range
    compression: Range
    peak_force: Range
    depth_at_rest: float | None
    restitution: float
    error: float


class Fall(NamedTuple):
    """Balls at the first step in contact: the heights of their drops, x and v."""

    drops: np.ndarray
    place: np.ndarray
    velocity: np.ndarray

    @classmethod
    def of(cls, step: Step, height: float, gravity: float, *, half_steps: bool) -> "Fall":
        """Falls from about a height, which meet the wall at all instants within a step."""
        g = gravity
        h = step.size
        drops = height + math.sqrt(2 * g * height) * h * np.linspace(-0.5, 0.5, _SAMPLES)
        # A drop of less than a step.
        drops = np.maximum(drops, _LEAST * height)
        # x_n = drop - g h² n(n + 2a)/2 and v_n = -g h (n - 1/2 + a), with a = 1/2 or 0.
        late = 0.0 if half_steps else 0.5
        n = np.ceil(np.sqrt(late * late + 2 * drops / (g * h * h)) - late) - step.ahead
        x = drops - g * h * h * n * (n + 2 * late) / 2
        # A ball at exactly the level of the wall is not yet in contact.
        x = np.where(x == 0, -np.finfo(float).tiny, x)
        return cls(drops, x, -g * h * (n - 0.5 + late))

    def restitutions(
        self, place: np.ndarray, velocity: np.ndarray, size: float, gravity: float
    ) -> np.ndarray:
        """√(h′/h) of balls that have left at a place with a velocity; 0 for those that have not."""
        gained = size * gravity
        steps = np.floor(np.maximum(velocity, 0.0) / gained)
        top = place + size * (steps * velocity - gained * steps * (steps + 1) / 2)
        top = np.where((place >= 0) & (velocity > 0), np.maximum(top, 0.0), 0.0)
        return np.sqrt(top / self.drops)


def restitutions_in_steps(
    step: Step, height: float, gravity: float, contact_steps: float, *, half_steps: bool
) -> np.ndarray:
    """√(h′/h) of balls that are dropped from about a height in m, at all instants within a step.

    Examples
    --------
    Small steps conserve the energy of an elastic contact:

    >>> from bouncing_ball_contacts.engines.scheme import Scheme
    >>> from bouncing_ball_contacts.engines.steps import LinearStep
    >>> from bouncing_ball_beyond.models.damping import Release
    >>> step = LinearStep.of(Scheme.SEMI_IMPLICIT, 1e4, 0.0, Release.FORCE, 1e-5)
    >>> found = restitutions_in_steps(step, 0.2, 9.81, 3142, half_steps=False)
    >>> bool(abs(found - 1).max() < 1e-3)
    True
    """
    fall = Fall.of(step, height, gravity, half_steps=half_steps)
    most = patience(contact_steps)
    x, v = until_outside(step, fall.place, fall.velocity, most, gravity)
    return fall.restitutions(x, v, step.size, gravity)


def drop_in_steps(
    step: Step,
    mass: float,
    height: float,
    gravity: float,
    contact_steps: float,
    restitution: float,
    *,
    half_steps: bool,
    is_stable: bool = True,
) -> DropInSteps:
    """A drop from a height in m of a ball with a mass in kg, of which a free impact takes so many
    steps and has the r that was asked for. The steps are stable unless said.

    Examples
    --------
    The force of an elastic contact that is hardly loaded by gravity is v√(km):

    >>> from bouncing_ball_contacts.engines.scheme import Scheme
    >>> from bouncing_ball_contacts.engines.steps import LinearStep
    >>> from bouncing_ball_beyond.models.damping import Release
    >>> step = LinearStep.of(Scheme.SEMI_IMPLICIT, 1e6, 0.0, Release.FORCE, 1e-5)
    >>> drop = drop_in_steps(step, 2.0, 0.2, 10.0, 314, 1.0, half_steps=False)
    >>> bool(abs(drop.peak_force.most / (2.0 * 2.0 * 1e3) - 1) < 0.01), drop.depth_at_rest
    (True, 1e-05)
    """
    fall = Fall.of(step, height, gravity, half_steps=half_steps)
    deepest = -fall.place
    hardest = np.zeros_like(deepest)
    last = fall.place, fall.velocity
    most = patience(contact_steps)
    for x, v, force in steps_inside(step, *last, most, gravity):
        deepest = np.maximum(deepest, -x)
        hardest = np.maximum(hardest, force)
        last = x, v
    found = fall.restitutions(*last, step.size, gravity)
    return DropInSteps(
        height=height,
        # Relative to the drop of each ball, of which one is the drop asked for.
        rise=Range.of(height * found**2),
        compression=Range.of(deepest),
        peak_force=Range.of(mass * hardest),
        depth_at_rest=step.depth_at_rest(gravity) if is_stable else None,
        restitution=float(found.mean()),
        error=float(np.abs(found - restitution).max()),
    )
