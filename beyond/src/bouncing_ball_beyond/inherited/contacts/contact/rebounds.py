"""Impacts of a contact law on a table at rest with gravity, dimensionless.

The rebound is that of the dynamics of the law at Λ = 0. The way down into the contact, which also a
ball takes that never leaves again, is one integration up to its turn.
"""

import math
from collections.abc import Callable
from functools import cache, lru_cache

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.laws.march import march
from bouncing_ball_beyond.models.laws.panel import Start
from bouncing_ball_beyond.models.laws.scales import rest, scales

SLOWED = 0.01
"""How much less a ball bounces than a free impact at the speed of :func:`slowed`."""
# The tolerance of the integration of the compression: a few hundred roundings.
_TOLERANCE = 1e-13
# Times of the scale of a contact after which a ball that has not turned lies on the table.
_PATIENCE = 200.0
# Samples of the way down, and of the interval around the greatest of them.
_SAMPLES = 4001
_AROUND = 1001
# Decades in which the first speed is searched for at which gravity lowers r by less than 1 %, and
# steps from there to the half of the speed.
_DECADES = 6
_HALVES = 80
# Speeds between which the last one is found, as many at once as take hardly longer than one, and
# how closely its logarithm is found.
_GRID = 33
_CLOSE = 1e-10
# A loss of r that is rounding of its signature.
_ROUNDING = 1e-13


def rises(law: ContactLaw, speed: np.ndarray) -> np.ndarray:
    """The heights of rebounds after impacts with these speeds, dimensionless; 0 without a rebound.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> rises(SpringDamper(50.0, 0.0), np.array([2.0])).round(9).tolist()
    [2.0]
    """
    dynamics = law.dynamics(np.zeros(speed.size))
    impact = dynamics.start(np.zeros(speed.size), -np.asarray(speed, dtype=float))
    departure = next(dynamics.legs(impact)).departure
    flight = departure.flight
    height = flight.displacement + flight.velocity**2 / 2
    return np.where(departure.status == Status.BOUNCING, np.maximum(height, 0.0), 0.0)


def compression(law: ContactLaw, speed: float) -> tuple[float, float]:
    """The greatest penetration after an impact, and the greatest force over the weight.

    Examples
    --------
    An elastic ball sinks in to s + √(s² + v²/ω²), with the static deflection s = 1/ω², where the
    force is ω² times that:

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> depth, force = compression(SpringDamper(10.0, 0.0), 1.0)
    >>> bool(abs(depth - (0.01 + (0.0001 + 0.01) ** 0.5)) < 1e-12), round(force / depth, 6)
    (True, 100.0)
    """
    length, rate = (float(x[0]) for x in scales(law, np.array([speed]), np.ones(1)))
    unit = length / rate
    # Of some laws the damping depends on the speed with which the contact starts.
    started = law.started(speed)
    loaded = under(started, 1.0)

    def fall(_: float, state: np.ndarray) -> list[float]:
        p, v = state * [length, rate]
        force = max(float(loaded.force(np.array([max(p, 0.0)]), np.array([v]))[0]), 0.0)
        return [v / rate, (1 - force) * unit / rate]

    def turn(_: float, state: np.ndarray) -> float:
        return float(state[1])

    turn.terminal = True  # type: ignore[attr-defined]
    turn.direction = -1  # type: ignore[attr-defined]
    run = scipy.integrate.solve_ivp(
        fall, (0.0, _PATIENCE), [0.0, speed / rate], method="DOP853", events=turn,
        rtol=_TOLERANCE, atol=_TOLERANCE, dense_output=True,
    )  # fmt: skip
    # Densely at the start, where a damper acts from the first instant on.
    times = run.t[-1] * np.linspace(0.0, 1.0, _SAMPLES) ** 2

    def contact_motion(times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        p, v = run.sol(times) * np.array([[length], [rate]])
        return p, v, np.ones_like(times)

    deepest, heaviest = greatest_loads(started, contact_motion, times)
    turned = run.t_events[0].size > 0
    return deepest if turned else max(rest(law), deepest), max(heaviest, 1.0)


def greatest_loads(
    law: ForceLaw,
    motion: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]],
    times: np.ndarray,
) -> tuple[float, float]:
    """The greatest penetration and the greatest force over the weight of a motion in contact.

    Parameters
    ----------
    law : ForceLaw
        That of a contact with this start (:meth:`~.ForceLaw.started`).
    motion : callable
        Penetration p, its rate p′ and the load a at times, which is 1 on a table at rest.
    times : ndarray
        Increasing times, dense enough to have only one maximum between three of them.

    Examples
    --------
    Undamped on a table at rest, p = (1 - cos 2t)/4 for ϖ = 2, if the ball starts at its level:

    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> law = SpringDamper(2.0, 0.0)
    >>> motion = lambda t: ((1 - np.cos(2 * t)) / 4, np.sin(2 * t) / 2, np.ones_like(t))
    >>> depth, force = greatest_loads(law, motion, np.linspace(0.0, 3.0, 100))
    >>> round(depth, 9), round(force, 9)
    (0.5, 2.0)
    """

    def loads(times: np.ndarray) -> np.ndarray:
        p, rate, load = motion(times)
        return np.array([p, under(law, load).force(np.maximum(p, 0.0), rate)])

    tops = loads(times).argmax(axis=1)
    found = []
    for which, top in enumerate(tops.tolist()):
        around = np.linspace(times[max(top - 1, 0)], times[min(top + 1, times.size - 1)], _AROUND)
        found.append(float(loads(around)[which].max()))
    return found[0], found[1]


def _restitutions(law: ContactLaw, speed: np.ndarray) -> np.ndarray:
    """r of free impacts; NaN if one does not end, as a fast one if the loss grows with the speed.

    The signature of a law has this r too, but is computed with all its derivatives.
    """
    known = law.constant_signature
    if known is not None:
        return np.full(speed.shape, float(known.restitution))
    zero = np.zeros(speed.shape)
    start = Start(depth=zero, rate=speed, phase=zero, amplitude=zero, weight=zero)
    return -march(law, start).rate / speed


# An answer asks for it of the same contact several times.
@lru_cache(maxsize=64)
def slowed(law: ContactLaw, fast: float) -> float | None:
    """The speed at which gravity lowers r by one part in a hundred: 0 if it does at no speed, and
    None if it lowers r by more at every speed.

    ``fast`` is a speed at which gravity is not felt, unless the loss grows with the speed. r is
    that of a free impact of the same speed. Faster impacts have this r more closely, slower ones
    are below it, unless nothing is lost.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> contact = SpringDamper(1.0, 0.2)
    >>> speed = np.array([slowed(contact, 1e5)])
    >>> share = np.sqrt(2 * rises(contact, speed)) / speed / contact.restitution
    >>> share.round(9).tolist()
    [0.99]
    """

    def restitution(logarithm: float) -> float:
        return float(_restitutions(law, np.exp([logarithm]))[0])

    def surpluses(logarithms: np.ndarray) -> np.ndarray:
        speed = np.exp(logarithms)
        return np.sqrt(2 * rises(law, speed)) / speed - (1 - SLOWED) * _restitutions(law, speed)

    @cache
    def surplus(logarithm: float) -> float:
        return float(surpluses(np.array([logarithm]))[0])

    # A loss that grows with the speed stops fast balls.
    tried = (math.log(fast) - math.log(10) * np.arange(_DECADES)).tolist()
    if restitution(tried[0]) > 1 - _ROUNDING:
        return 0.0
    upper = next((x for x in tried if restitution(x) > 0 and surplus(x) >= 0), None)
    if upper is None:
        return None
    for _ in range(_HALVES):
        lower = upper - math.log(2)
        if surplus(lower) < 0:
            break
        upper = lower
    else:
        return 0.0
    while upper - lower > _CLOSE:
        grid = np.linspace(lower, upper, _GRID)
        above = surpluses(grid) >= 0
        # The ends are known.
        first = 1 + int(np.argmax([*above[1:-1], True]))
        lower, upper = grid[first - 1 : first + 1].tolist()
    return math.exp((lower + upper) / 2)
