"""Any periodic orbit followed along any parameter, and its special orbits in two, for a user."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    POINTS,
    Points,
    checked_number,
    chosen,
)
from bouncing_ball_beyond.inherited.errors import (
    NoOrbitError,
    ParameterError,
    Range,
    shortened,
    suggesting,
)
from bouncing_ball_beyond.periodic.branches import curves, following, grazing, switching
from bouncing_ball_beyond.periodic.branches.closed import CLOSED, one_turn, without_start
from bouncing_ball_beyond.periodic.branches.labelled import FollowedBranch
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Balls, Path
from bouncing_ball_beyond.periodic.orbits.ends import ENDS, Window, bound_in_words, reason_at
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.paths import balls_along, name_of
from bouncing_ball_beyond.periodic.orbits.special import Special

MOST_POINTS = 500
"""Default of the largest number of points of a branch and a curve in each direction."""
# A parameter enters the equations as arsinh, and comes back with a rounding error.
_REACHED = 1e-12


@suggesting
def follow(
    orbit: Orbit,
    *,
    along: str | Path | tuple[str | Path, str | Path] | None = None,
    to: float | tuple[float, float] | None = None,
    points: Points = MOST_POINTS,
    ranges: Mapping[str, Sequence[float]] | None = None,
) -> FollowedBranch:
    """The branch of a periodic orbit along a parameter, or the curve of a special orbit in two.

    An ordinary orbit is followed up to a value of the parameter or to the end of its branch, or
    both ways through a range of the parameter. From a
    period doubling the branch of twice the period is followed, away from the doubling, from a
    period halving that of half the period, from the grazing of a flight that of the orbits with one
    impact more, and from the grazing of a release the branch on which it lies. The special orbit at
    which a branch starts is not listed among its special orbits. A saddle-node has orbits on one
    side of the parameter only, and two branches there: the stable one is followed. The other one
    comes behind the saddle-node if an orbit of the stable one is followed towards it. At the
    grazing of an impact, at a lost release and at the end of sticking a branch ends, and a closed
    branch at its start. With two parameters the curve of special orbits of this kind is followed in
    both directions, and from the grazing of an impact that of the grazing flight without it.

    Parameters
    ----------
    orbit : Orbit
        An orbit of :func:`bouncing_ball_beyond.orbit`, :func:`orbit_of_motion` or of a branch, such
        as ``found.first("period doubling")``.
    along : str or ParameterPath or two of them, optional
        The parameter: "amplitude", or one of the law, such as "frequency_ratio", "damping_ratio",
        "restitution" or the "stiffness" of a contact law. "frequency" is that of the table at a
        fixed stroke a, Ω/√(g/a) = √Λ, along which the parameters of the contact change as well. A
        :class:`ParameterPath` has parameters as functions of one variable. The default is the
        parameter of the branch from which the orbit comes, otherwise the amplitude; orbits do not
        know a path of your own, so that it is given again.
    to : float or two of them, optional
        The value at which the branch ends; by default the parameter rises to the end of its
        range, or to ten times its first value, and at least 10, if the range has no end.
        Behind a saddle-node the parameter moves back, at most as far beyond its first value; if the
        value is beyond the saddle-node, ``end_reason`` says so. With two values the branch through
        an ordinary orbit or a saddle-node is followed both ways between them.
    points : int
        The largest number of points, of a curve in each direction; at least 10.
    ranges : mapping, optional
        For a curve, the ranges of its parameters outside which it is not followed, by name.

    Returns
    -------
    FollowedBranch
        The orbits in order, the special ones with their kinds, and why the branch ends. Its
        ``to_dataset()`` has their observables, stability and admissibility.

    Raises
    ------
    NoOrbitError
        If there is no orbit at the start, if no branch leaves from it, if it leaves from a period
        doubling or a grazing to the other side than ``to``, or if the orbit is not on the path.
    ModelError
        If a parameter is unknown, of a wrong type, or out of range.

    Examples
    --------
    >>> import bouncing_ball_beyond
    >>> ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    >>> found = follow(bouncing_ball_beyond.orbit(ball, amplitude=1.0), to=1.2)
    >>> [(kind, round(each.amplitude, 6)) for kind, each in found.special_states()]
    [('period doubling', 1.037456)]
    >>> found.end_reason
    'amplitude = 1.2 is reached'

    Both ways, through the saddle-node:

    >>> whole = follow(bouncing_ball_beyond.orbit(ball, amplitude=1.0), to=(0.1, 1.2))
    >>> [kind for kind, _ in whole.special_states()]
    ['saddle-node', 'period doubling']

    The branch of twice the period, and the curve of period doublings in two parameters:

    >>> doubling = found.first("period doubling")
    >>> twice = follow(doubling, to=1.1)
    >>> twice.impacts, twice.orbits[-1].is_stable()
    (2, True)
    >>> curve = follow(doubling, along=("amplitude", "restitution"), points=10)
    >>> curve.kind, len(curve) < 20
    ('period doubling', True)
    """
    _check_orbit(orbit)
    most = checked_number("points", points, POINTS)
    parameters = _parameters(orbit, along)
    if orbit.amplitude == 0:
        raise NoOrbitError(
            "the table rests at this orbit, where the phase has no meaning: follow one at Λ > 0"
        )
    if len(parameters) == 2:
        if to is not None:
            raise ParameterError(
                "{to} is the end of a branch: a curve in two parameters has ranges"
            )
        return _curve(orbit, parameters, {} if ranges is None else ranges, most)
    if ranges is not None:
        raise ParameterError("{ranges} are those of a curve in two parameters: a branch has {to}")
    (parameter,) = parameters
    if orbit.kind in ENDS:
        raise NoOrbitError(f"the branch ends at the {reason_at(Special(orbit.kind))}")
    if isinstance(to, list | tuple | np.ndarray):
        found = _both_ways(orbit, parameter, to, most)
    else:
        found = _one_way(orbit, parameter, to, most)
    return FollowedBranch(found)


def _one_way(orbit: Orbit, along: str | Path, to: float | None, most: int) -> following.Followed:
    """The branch from an orbit on, as its kind requires."""
    balls, (name,) = balls_along(orbit.model, orbit.amplitude, along)
    value = None if to is None else _value(balls, name, to)
    start = orbit
    towards = None
    if orbit.kind == Special.PERIOD_DOUBLING:
        start, towards = switching.first_doubled(orbit, along, value)
    elif orbit.kind == Special.PERIOD_HALVING:
        start = switching.halved(orbit)
    elif orbit.kind == Special.SADDLE_NODE:
        towards = switching.sides(orbit, along).stable
    elif orbit.kind == Special.GRAZING_FLIGHT:
        start, towards = grazing.first_with_one_more(orbit, along, value)
    branch = following.branch_from(start, along, value, towards=towards, most=most)
    found = without_start(one_turn(branch), replace(start, kind=str(orbit.kind)))
    return found if value is None else _beyond_fold(found, orbit, float(balls.values[name]), value)


def _beyond_fold(
    found: following.Followed, orbit: Orbit, start: float, to: float
) -> following.Followed:
    """A branch that turns back at a saddle-node before the value to which it was to be followed,
    whose end says so; any other branch as it is.
    """
    equations = found.problem.equations
    (name,) = equations.along
    along = equations.values(found.branch.points)[name]
    # The last point of a branch that ends at the value has it up to rounding.
    reached = np.max(np.sign(to - start) * (along - to)) >= -_REACHED * max(1.0, abs(to))
    folds = [y.point for y in found.special_points if y.name == Special.SADDLE_NODE]
    places = [float(equations.values(y)[name]) for y in folds]
    if orbit.kind == Special.SADDLE_NODE:
        places.insert(0, start)
    end = found.branch.end
    if to == start or reached or not places or str(end) == CLOSED:
        return found
    sentence = f"{end}; {bound_in_words(name, to)} is beyond the saddle-node at {places[0]:.6g}"
    return replace(found, branch=replace(found.branch, end=end._replace(sentence=sentence)))


def _both_ways(orbit: Orbit, along: str | Path, to: Any, most: int) -> following.Followed:
    """The branch through an orbit in a range of the parameter.

    Raises
    ------
    NoOrbitError
        If another branch leaves from the orbit.
    """
    balls, (name,) = balls_along(orbit.model, orbit.amplitude, along)
    within = _window(name, to, float(balls.values[name]))
    for value in (within.low, within.high):
        _value(balls, name, value)
    towards = None
    if orbit.kind == Special.SADDLE_NODE:
        towards = switching.sides(orbit, along).stable
    elif orbit.kind not in ("", Special.GRAZING_RELEASE):
        raise NoOrbitError(
            f"from a {orbit.kind} another branch leaves, in one direction: give one value of to"
        )
    ahead, back = (
        following.branch_from(
            orbit,
            along,
            increasing=sign > 0,
            towards=None if towards is None else sign * towards,
            within=within,
            most=most,
        )
        for sign in (1, -1)
    )
    closed = one_turn(ahead)
    if closed is not ahead:
        return closed
    return replace(ahead, branch=following.through_start(back.branch, ahead.branch))


def _value(balls: Balls, name: str, value: Any) -> float:
    """A value of the parameter at which a branch ends."""
    return checked_number(
        "to", value, AMPLITUDE_OF_ORBIT if name == LAMBDA else balls.range_of(name)
    )


def _check_orbit(orbit: Any) -> None:
    if not isinstance(orbit, Orbit):
        kind = type(orbit).__name__
        hint = ": give one of them" if kind == "list" else ""
        raise ParameterError(f"follow needs an orbit of bouncing_ball_beyond, not {{}}{hint}", kind)
    if orbit.shape:
        raise ParameterError("follow needs a single orbit, not {}", str(orbit.size))
    if not orbit.exists:
        raise NoOrbitError("follow needs an orbit, but there is none: its quantities are NaN")


def _parameters(orbit: Orbit, along: Any) -> tuple[str | Path, ...]:
    """The one or two parameters, or paths, along which an orbit is followed."""
    if along is None:
        return orbit.along[:1]
    given = tuple(along) if isinstance(along, list | tuple) else (along,)
    if not all(isinstance(each, str | Path) for each in given):
        raise ParameterError(
            "{along} = {} is not the name of a parameter or two, or a path", shortened(along)
        )
    if len(given) not in (1, 2) or len({*map(name_of, given)}) < len(given):
        raise ParameterError(
            "{along} = {} is not one parameter or two different ones", shortened(along)
        )
    return given


def _curve(
    orbit: Orbit, parameters: tuple[str | Path, ...], ranges: Any, most: int
) -> FollowedBranch:
    """The curve of special orbits of the orbit's kind in two parameters."""
    if not orbit.kind:
        raise NoOrbitError(
            "an ordinary orbit has no curve in two parameters: give a special one, such as "
            'follow(orbit).first("saddle-node")'
        )
    if orbit.kind == Special.GRAZING_IMPACT:
        orbit = grazing.with_one_less(orbit)
    balls, names = balls_along(orbit.model, orbit.amplitude, *parameters)
    first, second = names
    if not isinstance(ranges, Mapping):
        given = f'such as {{"{first}": (low, high), "{second}": (low, high)}}'
        raise ParameterError("{ranges} = {} is not a range by name, {}", shortened(ranges), given)
    for name in ranges:
        chosen("ranges", name, names)
    values = balls.values
    windows = [
        _window(name, ranges[name], float(values[name])) if name in ranges else None
        for name in names
    ]
    found = curves.curve_through(
        orbit,
        Special(orbit.kind),
        *parameters,
        along_window=windows[0],
        across_window=windows[1],
        most=most,
    )
    return FollowedBranch(found, str(orbit.kind))


def _window(name: str, given: Any, start: float) -> Window:
    """The range of a parameter on a branch or a curve, which contains its value at the start."""
    several = isinstance(given, list | tuple | np.ndarray)
    numbers = [checked_number("ranges", x, Range()) for x in given] if several else []
    if len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise ParameterError(
            f"the range of {name} = {{}} is not two numbers of which the second is larger",
            shortened(given),
        )
    low, high = numbers
    # The orbit at the end of a branch has the value of its parameter up to rounding.
    slack = _REACHED * max(1.0, abs(start))
    if not low - slack <= start <= high + slack:
        raise ParameterError(
            f"the range {low:g} to {high:g} does not contain {name} = {start:g}, the value at the "
            "start"
        )
    return Window(min(low, start), max(high, start))
