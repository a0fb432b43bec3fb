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

from bouncing_ball_beyond.inherited.errors import NoOrbitError, suggesting
from bouncing_ball_beyond.inherited.numerics.corrector import plane
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.branches.following import point_near
from bouncing_ball_beyond.periodic.orbits.balls import Path
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.paths import place_along
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import newton_short
from bouncing_ball_beyond.periodic.orbits.special import Special, flight_margin
from bouncing_ball_beyond.periodic.orbits.steps import NEARBY

# A slow impact lasts about 2v/a. The parameter changes as at the grazing if v/a is this share of
# the duration of a free impact, which is about π/ϖ for a spring. An impact that is an instant is
# compared with half a period of the table.
_SLOW = 3e-4
_OF_INSTANT = np.pi
# Samples of a flight in which its lowest point is searched, and rounds of Newton's method for it.
_SAMPLES = 2001
_ROUNDS = 8
# A flight touches the table if its lowest point is this near. Grazings are located to 1e-12.
_TOUCHES = 1e-9
# A flight this far below the table does not graze it at the place of an impact that is left out.
_BELOW = 1e-3
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


class Grazing(NamedTuple):
    """A grazing flight: the equations of its orbit along a parameter, the point of the orbit, where
    the flight touches the table, and the speed of a slow impact there.
    """

    problem: OrbitEquations
    point: np.ndarray
    touch: Touch
    slow: float

    @property
    def parameter(self) -> float:
        """The value of the parameter."""
        (name,) = self.problem.along
        return float(self.problem.values(self.point)[name])


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
    >>> import bouncing_ball_beyond
    >>> ball = bouncing_ball_beyond.rigid(restitution=0.5)
    >>> one = bouncing_ball_beyond.orbit(ball, amplitude=2.0, side="unstable")
    >>> found = bouncing_ball_beyond.follow(one, to=3.0)
    >>> form = bouncing_ball_beyond.grazing_form(found.first("grazing of a flight"))
    >>> round(form.coefficient / (1.5 * (2 * form.acceleration) ** 0.5), 12)
    1.0
    """
    _require_grazing(orbit)
    name = orbit.along[0]
    grazing = _grazing(orbit, name)
    touch = grazing.touch
    first, nearer = _two_with_one_more(grazing)
    restitution = -1.0
    slope = 0.0
    if _is_instant(orbit.model):
        # At a vanishing impact speed.
        restitution = float(orbit.model.signature(1e-9).restitution)
        at = grazing.parameter
        # The term with v² cancels.
        slope = (4 * nearer.parameters[name] - first.parameters[name] - 3 * at) / grazing.slow
    opens_upwards = bool(first.parameters[name] > nearer.parameters[name])
    above, below = (_height(grazing, sign * _ASIDE) for sign in (1.0, -1.0))
    return GrazingForm(
        leg=touch.leg,
        phase=touch.phase,
        acceleration=touch.acceleration,
        coefficient=(1 + restitution) * float(np.sqrt(2 * touch.acceleration)),
        slope=slope,
        along=name,
        opens_upwards=opens_upwards,
        persists=opens_upwards == (above < below),
    )


def _is_instant(model: Model) -> bool:
    """Whether the impacts are instants."""
    return bool(np.all(model.signature(_SLOW).duration == 0))


def _require_grazing(orbit: Orbit) -> None:
    if not isinstance(orbit, Orbit) or orbit.shape or orbit.kind != Special.GRAZING_FLIGHT:
        raise NoOrbitError("the orbit is no grazing of a flight of a branch")


def _grazing(orbit: Orbit, along: str | Path) -> Grazing:
    """The grazing of a flight of an orbit, along a parameter.

    Raises
    ------
    NoOrbitError
        If no flight of the orbit grazes, or if its model has no slow impacts.
    """
    _require_grazing(orbit)
    problem, guess = equations_of(orbit, along)
    here = point_near(problem, guess)
    dynamics: Any = problem.dynamics(here)[0]
    phase, velocity = problem.states(here)
    impact = dynamics.start(reduce_angle(phase), velocity)
    if np.any(dynamics.section().delay(impact) > _TOUCHES):
        raise NoOrbitError(
            f"in the {orbit.model.name} model an impact takes effect after a delay, so that none "
            "begins at a grazing flight"
        )
    touch = lowest_touch(problem, here)
    if not abs(touch.height) <= _TOUCHES:
        raise NoOrbitError(f"no flight of the orbit grazes: the lowest is at {touch.height:.1e}")
    free = _OF_INSTANT if _is_instant(orbit.model) else orbit.model.signature(_SLOW).duration
    return Grazing(problem, here, touch, _SLOW * touch.acceleration * float(free))


def lowest_touch(problem: OrbitEquations, y: np.ndarray) -> Touch:
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


def _height(grazing: Grazing, aside: float) -> float:
    """The least height of the flights beside an orbit, at another value of the parameter."""
    problem, y, *_ = grazing
    guess = np.array([*y[:-1], y[-1] + aside])
    return float(flight_margin(problem, point_near(problem, guess)))


def _two_with_one_more(grazing: Grazing) -> tuple[Orbit, Orbit]:
    """The orbits with one impact more whose additional impact is slow, and half as fast.

    Whether their parameter rises with the speed does not depend on the digits of the grazing.
    """
    return _one_more(grazing, grazing.slow), _one_more(grazing, grazing.slow / 2)


def _one_more(grazing: Grazing, slow: float) -> Orbit:
    """The orbit with one impact more, whose additional impact has this speed.

    Raises
    ------
    NoOrbitError
        If no such orbit is found.
    """
    problem, here, touch, _ = grazing
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
    guess = more.point(
        np.insert(phase, after, touch.phase - slow / touch.acceleration),
        np.insert(velocity, after, -slow),
        np.insert(duration, after, 2 * slow / touch.acceleration),
        **values,
    )
    axis = np.eye(guess.size)[2 * after + 1]
    with np.errstate(all="ignore"):
        found = newton_short(more, guess, plane(axis, guess), NEARBY)
    if not found.converged:
        raise NoOrbitError(
            f"no orbit with {more.impacts} impacts was found beside the grazing flight: residual "
            f"{float(found.residual):.1e} after {int(found.iterations)} Newton iterations"
        )
    return orbit_of_point(more, found.point)


def with_one_less(orbit: Orbit) -> Orbit:
    """The orbit without its grazing impact: there its flight grazes, up to the small speed that is
    left of this impact.

    Raises
    ------
    NoOrbitError
        If the orbit has no other impact, if the flight before the impact comes up to the table from
        below, as after a release by force, or if another flight is below the table.
    """
    if orbit.impacts == 1:
        raise NoOrbitError(
            "the only impact of the orbit grazes: there is no orbit without it whose flight grazes"
        )
    slow = int(np.argmin(np.abs(orbit.relative_impact_velocity)))
    equations, y = equations_of(orbit)
    if not equations.legs(y).acceleration[slow - 1] > 0:
        raise NoOrbitError(
            "the flight before this impact only just comes up to the level of the table: without "
            "the impact there is no orbit whose flight grazes"
        )
    turns = np.array(orbit.turns)
    turns[slow - 1] += turns[slow]
    without = replace(
        orbit,
        turns=np.delete(turns, slow),
        phases=np.delete(orbit.phases, slow),
        velocities=np.delete(orbit.velocities, slow),
        durations=np.delete(orbit.durations, slow),
        resumes=np.delete(np.broadcast_to(orbit.resumes, turns.shape), slow),
        kind=str(Special.GRAZING_FLIGHT),
    )
    touch = lowest_touch(*equations_of(without))
    if touch.height < -_BELOW:
        raise NoOrbitError(
            "no ball follows the orbit at this grazing impact: another flight is below the table "
            f"by {-touch.height:.2g}, so that the orbit without the impact has no grazing flight"
        )
    return without


def first_with_one_more(
    orbit: Orbit, along: str | Path, to: float | None
) -> tuple[Orbit, np.ndarray]:
    """The first orbit with one impact more, and the direction of the unknowns that leads away from
    the grazing: the additional impact gets faster.

    Raises
    ------
    NoOrbitError
        If there is none, or if the orbits exist on the other side than a value ``to``.
    """
    grazing = _grazing(orbit, along)
    first, nearer = _two_with_one_more(grazing)
    at = grazing.parameter
    (name,) = grazing.problem.along
    place, closer = (place_along(one.model, one.amplitude, along) for one in (first, nearer))
    above = place > closer
    if to is not None and to != at and (to > at) != above:
        where = "above" if above else "below"
        raise NoOrbitError(
            f"to = {to:g} is beyond the grazing: the orbits with {first.impacts} impacts exist "
            f"next to it only for {name} {where} {at:g}"
        )
    problem, _ = equations_of(first, along)
    return first, -np.eye(problem.size + 1)[2 * (grazing.touch.leg + 1) + 1]
