"""Impacts of a contact law on a table at rest with gravity, dimensionless.

The rebound is that of the dynamics of the law at Λ = 0. The way down into the contact, which also a
ball takes that never leaves again, is one integration up to its turn.
"""

import math

import numpy as np
import scipy

from bouncing_ball.errors import ModelError
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.scales import rest, scales
from bouncing_ball.models.sequence import Status

SLOWED = 0.01
"""How much less a ball bounces than a free impact at the speed of :func:`slowed`."""
# The tolerance of the integration of the compression: a few hundred roundings.
_TOLERANCE = 1e-13
# Times of the scale of a contact after which a ball that has not turned lies on the table.
_PATIENCE = 200.0
# Samples of the force on the way down; those beside the greatest are sampled again.
_SAMPLES = 4001
# Decades in which the first speed is searched for at which gravity lowers r by less than 1 %, and
# steps from there to the half of the speed.
_DECADES = 6
_HALVES = 80


def rises(law: ContactLaw, speed: np.ndarray) -> np.ndarray:
    """The heights of rebounds after impacts with these speeds, dimensionless; 0 without a rebound.

    Examples
    --------
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> rises(SpringDamper(50.0, 0.0), np.array([2.0])).round(9).tolist()
    [2.0]
    """
    dynamics = law.dynamics(np.zeros(speed.size))
    impact = dynamics.start(np.zeros(speed.size), -np.asarray(speed, dtype=float))
    departure = dynamics.depart(impact)
    flight = departure.flight
    height = flight.displacement + flight.velocity**2 / 2
    return np.where(departure.status == Status.BOUNCING, np.maximum(height, 0.0), 0.0)


def compression(law: ContactLaw, speed: float) -> tuple[float, float]:
    """The greatest penetration after an impact, and the greatest force over the weight.

    Examples
    --------
    An elastic ball sinks in to s + √(s² + v²/ω²), with the static deflection s = 1/ω², where the
    force is ω² times that:

    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> depth, force = compression(SpringDamper(10.0, 0.0), 1.0)
    >>> bool(abs(depth - (0.01 + (0.0001 + 0.01) ** 0.5)) < 1e-12), round(force / depth, 6)
    (True, 100.0)
    """
    length, rate = (float(x[0]) for x in scales(law, np.array([speed]), np.ones(1)))
    unit = length / rate

    def force(p: np.ndarray, v: np.ndarray) -> np.ndarray:
        found = law.loaded_force(np.maximum(p, 0.0), v, 1.0)
        return np.maximum(found, 0.0)

    def motion(_: float, state: np.ndarray) -> list[float]:
        p, v = state * [length, rate]
        return [v / rate, float(1 - force(np.array([p]), np.array([v]))[0]) * unit / rate]

    def turn(_: float, state: np.ndarray) -> float:
        return float(state[1])

    turn.terminal = True  # type: ignore[attr-defined]
    turn.direction = -1  # type: ignore[attr-defined]
    run = scipy.integrate.solve_ivp(
        motion, (0.0, _PATIENCE), [0.0, speed / rate], method="DOP853", events=turn,
        rtol=_TOLERANCE, atol=_TOLERANCE, dense_output=True,
    )  # fmt: skip
    # Densely at the start, where a damper acts from the first instant on.
    times = run.t[-1] * np.linspace(0.0, 1.0, _SAMPLES) ** 2
    for _ in range(2):
        p, v = run.sol(times) * np.array([[length], [rate]])
        forces = force(p, v)
        top = int(np.argmax(forces))
        times = np.linspace(times[max(top - 1, 0)], times[min(top + 1, times.size - 1)], _SAMPLES)
    turned = run.t_events[0].size > 0
    deepest = float(run.y[0, -1]) * length if turned else max(rest(law), float(p.max()))
    return deepest, float(max(forces.max(), 1.0))


def _ends(law: ContactLaw, speed: float) -> bool:
    """Whether a free impact ends, as a fast one does not where the loss grows with the speed."""
    try:
        return float(law.signature(speed).restitution) > 0
    except ModelError:
        return False


def slowed(law: ContactLaw, fast: float) -> float | None:
    """The speed at which gravity lowers r by one part in a hundred; None if it does at no speed.

    ``fast`` is a speed at which gravity is not felt. r is that of a free impact of the same speed.
    Faster impacts have this r more closely, slower ones are below it.

    Examples
    --------
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> contact = SpringDamper(1.0, 0.2)
    >>> speed = np.array([slowed(contact, 1e5)])
    >>> share = np.sqrt(2 * rises(contact, speed)) / speed / contact.restitution
    >>> share.round(9).tolist()
    [0.99]
    """

    def surplus(logarithm: float) -> float:
        speed = np.exp([logarithm])
        free = law.signature(speed).restitution
        return float((np.sqrt(2 * rises(law, speed)) / speed - (1 - SLOWED) * free)[0])

    # A loss that grows with the speed stops fast balls.
    tried = math.log(fast) - math.log(10) * np.arange(_DECADES)
    upper = next((x for x in tried.tolist() if _ends(law, math.exp(x)) and surplus(x) >= 0), None)
    for _ in range(_HALVES):
        if upper is None:
            return None
        lower = upper - math.log(2)
        if surplus(lower) < 0:
            return math.exp(scipy.optimize.brentq(surplus, lower, upper, xtol=1e-10))
        upper = lower
    return None
