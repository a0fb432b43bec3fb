"""A free impact on Drake's contact with Hunt and Crossley's damping, at a time step that is given.

In units of the impact speed V and of 1/ω, ω = √(k/m), it depends on h = ωΔt and D = dV. The steps
are implicit ones, whose error falls about as 1/N with the number N of steps in a contact.
"""

import math
from dataclasses import replace

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball_contacts.engines.given_step import AtStep, Spread, spread
from bouncing_ball_contacts.engines.steps import HuntCrossleyStep, patience, until_outside

# Between two jumps r is smooth, and is known to this part of itself.
_SMOOTH = 1e-6
# Steps in a contact above which the exact impact is as good, and the fewest of a simulation.
_MOST_STEPS = 20_000
_FEWEST_STEPS = 1e-3
_FINE = 1e-9


def spread_of_damping(damping: float, step: float, most: int) -> Spread:
    """The range and the mean of r with D and h; 0 for a ball that is inside after ``most`` steps.

    Examples
    --------
    Small steps lose what the work of the damper is, (1 - rD) exp(D (1 + r)) = 1 + D:

    >>> r = spread_of_damping(0.5, 1e-3, 5000).mean
    >>> bool(abs((1 - 0.5 * r) * np.exp(0.5 * (1 + r)) - 1.5) < 1e-3)
    True
    """
    of_contact = HuntCrossleyStep(1.0, damping, step)

    def impacts(fraction: np.ndarray) -> np.ndarray:
        x, v = until_outside(of_contact, -step * fraction, np.full(fraction.shape, -1.0), most)
        return np.where(x < 0, 0.0, v)

    return spread(impacts, _SMOOTH)


def at_step_of_law(
    engine: str,
    law: LinearHuntCrossley,
    speed: float,
    time_step: float,
    error: float,
    asked: LinearHuntCrossley | None = None,
) -> AtStep:
    """What the contact of a law does with a time step in s, at an impact speed in m/s.

    The laws have their parameters in SI units, with the stiffness per unit of mass; ``asked`` is
    the one that was asked for, if it is another one.

    Raises
    ------
    ModelError
        If contact and step differ by so much that no simulation has both.

    Examples
    --------
    >>> found = at_step_of_law("drake", LinearHuntCrossley(2e5, 0.5), 1.0, 1e-3, 0.001)
    >>> found.is_within, found.least < found.most < found.restitution
    (False, True)
    """
    impact = law.signature(speed)
    duration = float(impact.duration)
    exact = float(impact.restitution)
    wanted = exact if asked is None else float(asked.signature(speed).restitution)
    steps = duration / time_step
    if steps < _FEWEST_STEPS:
        raise ModelError(
            f"a contact of {duration:.3g} s takes {steps:.3g} time steps of {time_step:.3g} s, "
            f"which is not above {_FEWEST_STEPS:g}: check the units"
        )
    h = math.sqrt(float(law.stiffness)) * time_step
    damping = float(law.damping) * speed

    found = Spread(exact, exact, exact)
    if steps <= _MOST_STEPS:
        found = spread_of_damping(damping, h, patience(steps))
    return replace(AtStep.of(engine, time_step, steps, wanted, found, error), speed=speed)


def retuned_damping_of_law(at: AtStep, law: LinearHuntCrossley) -> float | None:
    """The damping in s/m with which the mean r at the step is that of the law; None if none is."""
    h = math.sqrt(float(law.stiffness)) * at.time_step

    def surplus(ratio: float) -> float:
        return spread_of_damping(ratio, h, patience(at.steps)).mean - at.restitution

    if at.speed is None or surplus(0.0) < 0:
        return None
    damping = float(law.damping) * at.speed
    return float(scipy.optimize.brentq(surplus, 0.0, damping, xtol=_FINE)) / at.speed


def missing_speed() -> ParameterError:
    """The error that a time step is given, and no impact speed on which r depends."""
    return ParameterError(
        "{time_step} with hunt_crossley_dissipation needs {speed} of an impact, or a table, "
        "because r depends on the speed"
    )
