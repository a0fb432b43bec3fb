r"""At a grazing flight: the branch with one impact more, and the square root of the return map.

A flight touches the table at a local minimum of δ, where δ′ = 0 and δ″ = a > 0. If the minimum of a
neighbouring flight is at -d < 0, the ball lands there with δ′ = -√(2ad). In the restitution model
it then leaves with r √(2ad), whereas the flight without an impact would have had -√(2ad): the
impact changes the velocity by ``S √d`` with the coefficient ::

    S = (1 + r) √(2a)

Because of this square root the derivative of the return map is infinite at the grazing (Nordmark).
A contact of finite duration has S = 0: a slow impact lasts for about 2√(2d/a), and in this time the
spring and the damper change the velocity by a multiple of d, so that the derivative only jumps.

With the speed v of the additional impact as the unknown the equations are smooth. The branch of the
orbits with k + 1 impacts therefore begins at the grazing with v = 0, and the parameter changes as
``slope v`` in the restitution model and as v² for contacts of finite duration. It persists if its
orbits exist where the orbit with k impacts meets the table, and otherwise both exist on the same
side and disappear together.

Source: A. B. Nordmark, *Non-periodic motion caused by grazing incidence in an impact oscillator*,
Journal of Sound and Vibration 145 (1991) 279-297.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.errors import NoOrbitError, suggesting
from bouncing_ball.models.model import Model
from bouncing_ball.numerics.corrector import NewtonSettings, newton, plane
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.branches.following import point_near
from bouncing_ball.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball.periodic.orbits.problem import OrbitEquations
from bouncing_ball.periodic.orbits.special import Special, flight_margin

# Speeds of the additional impact of the first orbit, of which the first that Newton's method
# reaches is taken.
_SPEEDS = (3e-3, 1e-3, 3e-4)
_NEARBY = NewtonSettings(max_iterations=30, longest=0.01)
# Samples of a flight in which its lowest point is searched, and rounds of Newton's method for it.
_SAMPLES = 2001
_ROUNDS = 8
# A flight touches the table if its lowest point is this near. Grazings are located to 1e-12.
_TOUCHES = 1e-9
# The change of the parameter over which the height of the flight is compared.
_ASIDE = 1e-6


class Touch(NamedTuple):
    """Where a flight touches the table: the number of the impact before, the time since its contact
    ended, the table's phase, δ″, and the least height δ.
    """

    leg: int
    time: float
    phase: float
    acceleration: float
    height: float


@dataclass(frozen=True)
class GrazingForm:
    """What happens at a grazing flight, see :func:`grazing_form`.

    ``leg`` is the number of the impact before the flight, ``phase`` that of the table at the touch,
    and ``acceleration`` a = δ″ there; ``coefficient`` is S. ``slope`` is the derivative of the
    parameter ``along`` by the speed of the additional impact, 0 for contacts of finite duration,
    and ``opens_upwards`` tells whether the orbits with one impact more exist at larger values of
    it. ``persists`` tells whether they exist where the flight would be below the table.
    """

    leg: int
    phase: float
    acceleration: float
    coefficient: float
    slope: float
    along: str
    opens_upwards: bool
    persists: bool


@suggesting
def grazing_form(orbit: Orbit) -> GrazingForm:
    """The square root of the return map at the grazing of a flight, and the branch with one impact
    more.

    Parameters
    ----------
    orbit : Orbit
        A special orbit of a branch, such as ``found.first("grazing of a flight")``.

    Raises
    ------
    NoOrbitError
        If no flight of the orbit grazes, or if no orbit with one impact more is found.

    Examples
    --------
    >>> import bouncing_ball
    >>> ball = bouncing_ball.rigid(restitution=0.5)
    >>> one = bouncing_ball.orbit(ball, amplitude=2.0, side="unstable")
    >>> found = bouncing_ball.follow(one, to=3.0)
    >>> form = bouncing_ball.grazing_form(found.first("grazing of a flight"))
    >>> round(form.coefficient / (1.5 * (2 * form.acceleration) ** 0.5), 12)
    1.0
    """
    _require_grazing(orbit)
    name = orbit.along[0]
    problem, here = _problem(orbit, name)
    touch = _touch(problem, here)
    dynamics: Any = problem.dynamics(here)[0]
    instant = dynamics.contact is None
    at = float(problem.values(here)[name])
    # A slow impact is one that lasts shorter than an oscillation of the contact.
    slow = _SPEEDS[0] / float(np.max(dynamics.clock))
    speeds = (slow, slow / 2)
    moved = [one_more(orbit, name, speed).parameters[name] - at for speed in speeds]
    rates = [change / speed for change, speed in zip(moved, speeds, strict=True)]
    sides = [_height(problem, here, sign * _ASIDE) for sign in (1.0, -1.0)]
    above = moved[1] > 0
    restitution = _slow_restitution(orbit.model) if instant else -1.0
    return GrazingForm(
        leg=touch.leg,
        phase=touch.phase,
        acceleration=touch.acceleration,
        coefficient=(1 + restitution) * float(np.sqrt(2 * touch.acceleration)),
        slope=2 * rates[1] - rates[0] if instant else 0.0,
        along=name,
        opens_upwards=above,
        persists=bool(above == (sides[0] < sides[1])),
    )


def _slow_restitution(model: Model) -> float:
    """r at a vanishing impact speed."""
    return float(np.asarray(model.signature(1e-9).restitution))


def _require_grazing(orbit: Orbit) -> None:
    if not isinstance(orbit, Orbit) or orbit.shape or orbit.kind != Special.GRAZING_FLIGHT:
        raise NoOrbitError("the orbit is no grazing of a flight of a branch")


def _problem(orbit: Orbit, along: str) -> tuple[OrbitEquations, np.ndarray]:
    """The equations of a grazing orbit, and the orbit.

    Raises
    ------
    NoOrbitError
        If the orbit is no grazing of a flight, or if its model has no slow impacts.
    """
    _require_grazing(orbit)
    problem = orbit.problem(along)
    here = point_near(problem, orbit.point(problem))
    dynamics: Any = problem.dynamics(here)[0]
    phase, velocity = problem.states(here)
    impact = dynamics.start(reduce_angle(phase), velocity)
    if np.any(np.abs(dynamics.section(impact)[0] - impact.phase) > _TOUCHES):
        raise NoOrbitError(
            f"in the {orbit.model.name} model an impact takes effect after a delay, so that none "
            "begins at a grazing flight"
        )
    return problem, here


def _touch(problem: OrbitEquations, y: np.ndarray) -> Touch:
    """The lowest local minimum of the flights of an orbit."""
    legs = problem.legs(y)
    flight = legs.departure.flight
    lasts = problem.intervals(y) - legs.duration
    share = np.linspace(0, 1, _SAMPLES)[1:-1, np.newaxis]
    gap = np.array([flight.gap(row)[0] for row in share * lasts])
    inside = (gap[1:-1] < gap[:-2]) & (gap[1:-1] <= gap[2:])
    height = np.where(inside, gap[1:-1], np.inf)
    sample, leg = np.unravel_index(int(np.argmin(height)), height.shape)
    time = share[sample + 1] * lasts
    for _ in range(_ROUNDS):
        _, rate, acceleration, _ = flight.gap(time)
        time = time - np.where(np.arange(lasts.size) == leg, rate / acceleration, 0.0)
    low, _, acceleration, _ = flight.gap(time)
    phase = problem.states(y)[0] + legs.duration + time
    return Touch(
        leg=int(leg),
        time=float(time[leg]),
        phase=float(reduce_angle(phase[leg])),
        acceleration=float(acceleration[leg]),
        height=float(low[leg]),
    )


def _height(problem: OrbitEquations, y: np.ndarray, aside: float) -> float:
    """The least height of the flights beside an orbit, at another value of the parameter."""
    guess = np.array([*y[:-1], y[-1] + aside])
    return float(flight_margin(problem, point_near(problem, guess)))


def one_more(orbit: Orbit, along: str, speed: float | None = None) -> Orbit:
    """The orbit with one impact more beside a grazing flight, whose additional impact is slow.

    Parameters
    ----------
    orbit : Orbit
        The grazing of a flight.
    along : str
        The parameter that varies.
    speed : float, optional
        The speed of the additional impact.

    Raises
    ------
    NoOrbitError
        If the orbit is no grazing of a flight, or if no such orbit is found.
    """
    problem, here = _problem(orbit, along)
    touch = _touch(problem, here)
    if not abs(touch.height) <= _TOUCHES:
        raise NoOrbitError(f"no flight of the orbit grazes: the lowest is at {touch.height:.1e}")
    after = touch.leg + 1
    phase, velocity = problem.states(here)
    duration = problem.legs(here).duration
    passed = phase[touch.leg] + duration[touch.leg] + touch.time - touch.phase
    before = round(float(passed) / (2 * np.pi))
    turns = np.array(np.broadcast_to(problem.turns, phase.shape))
    rest = turns[touch.leg] - before
    turns[touch.leg] = before
    more = replace(
        problem,
        impacts=problem.impacts + 1,
        turns=np.insert(turns, after, rest),
        resumes=np.insert(problem.resuming, after, False),
    )
    values = problem.values(here)
    for slow in _SPEEDS if speed is None else (speed,):
        guess = more.point(
            np.insert(phase, after, touch.phase - slow / touch.acceleration),
            np.insert(velocity, after, -slow),
            np.insert(duration, after, 2 * slow / touch.acceleration),
            **values,
        )
        axis = np.eye(guess.size)[2 * after + 1]
        with np.errstate(all="ignore"):
            found = newton(more, guess, plane(axis, guess), _NEARBY)
        if found.converged:
            return orbit_of_point(more, found.point)
    raise NoOrbitError(
        f"no orbit with {more.impacts} impacts was found beside the grazing flight: residual "
        f"{float(found.residual):.1e} after {int(found.iterations)} Newton iterations"
    )


def faster(orbit: Orbit, along: str, leg: int) -> np.ndarray:
    """The direction of the unknowns in which the impact after another one, ``leg``, gets faster."""
    problem = orbit.problem(along)
    size = problem.size + 1
    return -np.eye(size)[2 * (leg + 1) + 1]


def first_with_one_more(orbit: Orbit, along: str, to: float | None) -> tuple[Orbit, np.ndarray]:
    """The first orbit with one impact more, and the direction that leads away from the grazing.

    Raises
    ------
    NoOrbitError
        If there is none, or if the orbits exist on the other side than a value ``to``.
    """
    found = one_more(orbit, along)
    problem, here = _problem(orbit, along)
    at = float(problem.values(here)[along])
    change = float(np.asarray(found.model.numbers().get(along, found.amplitude))) - at
    if to is not None and (to - at) * change < 0:
        where = "above" if change > 0 else "below"
        raise NoOrbitError(
            f"to = {to:g} is beyond the grazing: the orbits with {found.impacts} impacts exist "
            f"next to it only for {along} {where} {at:g}"
        )
    return found, faster(found, along, _touch(problem, here).leg)
