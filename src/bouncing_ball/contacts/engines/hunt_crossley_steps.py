r"""A free impact on Drake's contact with Hunt and Crossley's damping, in time steps.

The force of a step is that of its end, ``f = k (p - h v⁺)(1 - d v⁺)`` with both factors not below
0, where p is the penetration at its start and v⁺ the velocity of separation at its end. In units of
the impact speed V and of 1/ω, ω = √(k/m), with h = ωΔt and D = dV, ::

    v⁺ = v + h (p - h v⁺)(1 - D v⁺)

is a quadratic equation for v⁺. Without damping the step is one of implicit Euler. As a linear
damper of the parameters could, this one cannot take back the damping of the step, because it grows
with the penetration.

Source: Drake's documentation of its discrete contact approximations, "lagged" and "similar".
"""

import math

import numpy as np
from scipy.optimize import brentq

from bouncing_ball.contacts.engines.given_step import AtStep, Spread, spread
from bouncing_ball.errors import ModelError, ParameterError
from bouncing_ball.models.laws.hertzian import LinearHuntCrossley

# Between two jumps r is smooth, and is known to this part of itself.
_SMOOTH = 1e-6
# Steps in a contact above which the exact impact is as good, and the fewest of a simulation.
_MOST_STEPS = 20_000
_FEWEST_STEPS = 1e-3
# A ball that has not left after so many times the duration of a contact stays.
_PATIENCE = 20
_FEW = 200
_FINE = 1e-9


def impacts_in_steps(damping: float, step: float, fraction: np.ndarray, steps: int) -> np.ndarray:
    """r of free impacts with D and h, which begin at fractions of a step before the first one in
    contact; 0 for a ball that has not left after so many ``steps``.

    Examples
    --------
    Small steps lose what the work of the damper is, (1 - rD) exp(D (1 + r)) = 1 + D:

    >>> r = impacts_in_steps(0.5, 1e-3, np.array([0.5]), 5000)[0]
    >>> bool(abs((1 - 0.5 * r) * np.exp(0.5 * (1 + r)) - 1.5) < 1e-3)
    True
    """
    x = -step * np.asarray(fraction, dtype=float)
    v = np.full_like(x, -1.0)
    square = step * step * damping
    for _ in range(steps):
        inside = x < 0
        if not inside.any():
            break
        p = np.maximum(-x, 0.0)
        linear = 1 + step * p * damping + step * step
        free = step * p + v
        pushed = 2 * free / (linear + np.sqrt(linear * linear - 4 * square * free))
        least = np.minimum(p / step, 1 / damping) if damping > 0 else p / step
        v = np.where(inside & (v < least), pushed, v)
        x = np.where(inside, x + step * v, x)
    return np.where(x < 0, 0.0, v)


def at_step_of_law(
    law: LinearHuntCrossley, mass: float, speed: float, time_step: float, error: float
) -> AtStep:
    """What the contact of a law in SI units does with a time step in s, at an impact speed in m/s.

    Raises
    ------
    ModelError
        If contact and step differ by so much that no simulation has both.

    Examples
    --------
    >>> found = at_step_of_law(LinearHuntCrossley(2e5, 0.5), 0.5, 1.0, 1e-3, 0.001)
    >>> found.is_within, found.least < found.most < found.restitution
    (False, True)
    """
    impact = law.signature(speed)
    duration = float(impact.duration)
    exact = float(impact.restitution)
    steps = duration / time_step
    if steps < _FEWEST_STEPS:
        raise ModelError(
            f"a contact of {duration:.3g} s takes {steps:.3g} time steps of {time_step:.3g} s, "
            f"which is not above {_FEWEST_STEPS:g}: check the units"
        )
    h = math.sqrt(float(law.stiffness)) * time_step
    damping = float(law.damping) * speed
    patience = _FEW + int(_PATIENCE * steps)

    def found(ratio: float) -> Spread:
        if steps > _MOST_STEPS:
            return Spread(exact, exact, exact)
        return spread(lambda place: impacts_in_steps(ratio, h, place, patience), _SMOOTH)

    of_law = found(damping)
    off = of_law.error(exact)
    tuned = None
    if off > error and found(0.0).mean >= exact:
        tuned = float(brentq(lambda ratio: found(ratio).mean - exact, 0.0, damping, xtol=_FINE))
    return AtStep(
        engine="drake",
        time_step=time_step,
        steps=steps,
        is_stable=True,
        restitution=exact,
        least=of_law.least,
        most=of_law.most,
        error=off,
        allowed=error,
        is_within=off <= error,
        mean=of_law.mean,
        retuned=None if tuned is None else tuned / speed,
        speed=speed,
    )


def needs_speed() -> ParameterError:
    """The error that a time step is given, and no impact speed on which r depends."""
    return ParameterError(
        "{time_step} with hunt_crossley_dissipation needs {speed} of an impact, or a table, "
        "because r depends on the speed"
    )
