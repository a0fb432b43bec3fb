"""Any periodic orbit followed along any parameter, and its special orbits in two, for a user."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, overload

import numpy as np

from bouncing_ball.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    POINTS,
    Points,
    checked_number,
    chosen,
)
from bouncing_ball.errors import NoOrbitError, ParameterError, Range, shortened, suggesting
from bouncing_ball_beyond.periodic.branches import curves, following, grazing, switching
from bouncing_ball_beyond.periodic.branches.closed import one_turn, without_start
from bouncing_ball_beyond.periodic.branches.labelled import FollowedBranch, SpecialCurve, labelled
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Balls
from bouncing_ball_beyond.periodic.orbits.ends import ENDS, Window, reason_at
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.special import Special

MOST_POINTS = 500
"""Default of the largest number of points of a branch, and of a curve in each direction."""


@overload
def follow(
    orbit: Orbit, *, along: str | None = None, to: float | None = None, points: Points = MOST_POINTS
) -> FollowedBranch: ...


@overload
def follow(
    orbit: Orbit,
    *,
    along: tuple[str, str],
    points: Points = MOST_POINTS,
    ranges: Mapping[str, Sequence[float]] | None = None,
) -> SpecialCurve: ...


@suggesting
def follow(
    orbit: Orbit,
    *,
    along: str | tuple[str, str] | None = None,
    to: float | None = None,
    points: Points = MOST_POINTS,
    ranges: Mapping[str, Sequence[float]] | None = None,
) -> FollowedBranch | SpecialCurve:
    """The branch of a periodic orbit along a parameter, or the curve of a special orbit in two.

    An ordinary orbit is followed up to a value of the parameter or to the end of its branch. From a
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
    along : str or two of them, optional
        The parameter: "amplitude", or one of the law, such as "frequency_ratio", "damping_ratio",
        "restitution" or the "stiffness" of a contact law. The default is that of the branch from
        which the orbit comes, otherwise the amplitude.
    to : float, optional
        The value at which the branch ends; by default the parameter rises to the end of its
        range, or to ten times its first value, and at least 10, if the range has no end.
        Behind a saddle-node the parameter moves back, at most as far beyond its first value.
    points : int
        The largest number of points, of a curve in each direction.
    ranges : mapping, optional
        For a curve, the ranges of its parameters outside which it is not followed, by name.

    Returns
    -------
    FollowedBranch or SpecialCurve
        The parameter at each ``point``, ``phase``, ``contact_duration`` and the other observables
        of :func:`bouncing_ball_beyond.branch` for each ``impact``, and whether the orbit is
        ``stable`` and ``admissible``; ``special_kind`` and the place of the special orbits;
        ``end_reason`` says why the branch ends.

    Raises
    ------
    NoOrbitError
        If there is no orbit at the start, if no branch leaves from it, or if it leaves from a
        saddle-node, a period doubling or a grazing to the other side than ``to``.
    ModelError
        If a parameter is unknown, of a wrong type, or out of range.

    Examples
    --------
    >>> import bouncing_ball_beyond
    >>> ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    >>> found = follow(bouncing_ball_beyond.orbit(ball, amplitude=1.0), to=1.2)
    >>> found.special_kind.values.tolist(), found.special_amplitude.values.round(6).tolist()
    (['period doubling'], [1.037456])
    >>> str(found.end_reason[1].values)
    'amplitude = 1.2 is reached'

    The branch of twice the period, and the curve of period doublings in two parameters:

    >>> doubling = found.first("period doubling")
    >>> twice = follow(doubling, to=1.1)
    >>> twice.attrs["impacts"], bool(twice.stable[-1])
    (2, True)
    >>> curve = follow(doubling, along=("amplitude", "restitution"), points=10)
    >>> curve.attrs["curve_kind"], curve.sizes["point"]
    ('period doubling', 19)
    """
    _check_orbit(orbit)
    most = checked_number("points", points, POINTS)
    names = _names(orbit, along)
    if orbit.amplitude == 0:
        raise NoOrbitError(
            "the table rests at this orbit, where the phase has no meaning: follow one at Λ > 0"
        )
    if len(names) == 2:
        if to is not None:
            raise ParameterError(
                "{to} is the end of a branch: a curve in two parameters has ranges"
            )
        return _curve(orbit, names, {} if ranges is None else ranges, most)
    if ranges is not None:
        raise ParameterError("{ranges} are those of a curve in two parameters: a branch has {to}")
    (name,) = names
    balls = Balls(orbit.model, orbit.amplitude)
    allowed = AMPLITUDE_OF_ORBIT if name == LAMBDA else balls.range_of(name)
    value = None if to is None else checked_number("to", to, allowed)
    if orbit.kind in ENDS:
        raise NoOrbitError(f"the branch ends at the {reason_at(Special(orbit.kind))}")
    start = orbit
    towards = None
    if orbit.kind == Special.PERIOD_DOUBLING:
        start, towards = switching.first_doubled(orbit, name, value)
    elif orbit.kind == Special.PERIOD_HALVING:
        start = switching.halved(orbit)
    elif orbit.kind == Special.SADDLE_NODE:
        towards = _to_stable_side(orbit, name, value)
    elif orbit.kind == Special.GRAZING_FLIGHT:
        start, towards = grazing.first_with_one_more(orbit, name, value)
    found = following.branch_from(start, name, value, towards=towards, most=most)
    whole = without_start(one_turn(found), replace(start, kind=str(orbit.kind)))
    return FollowedBranch(**labelled(whole, "follow"))


def _to_stable_side(fold: Orbit, name: str, to: float | None) -> np.ndarray:
    """The direction of the unknowns in which the stable side of a saddle-node is followed.

    Raises
    ------
    NoOrbitError
        If the branch is to be followed to where it has no orbits.
    """
    sides = switching.sides(fold, name)
    if sides.above is not None and to is not None and to != sides.at:
        if (to > sides.at) != sides.above:
            where = "above" if sides.above else "below"
            raise NoOrbitError(
                f"to = {to:g} is beyond the saddle-node: its orbits exist only for {name} {where} "
                f"{sides.at:g}"
            )
    return sides.stable


def _check_orbit(orbit: Any) -> None:
    if not isinstance(orbit, Orbit):
        kind = type(orbit).__name__
        raise ParameterError("follow needs an orbit of bouncing_ball, not {}", kind)
    if orbit.shape:
        raise ParameterError("follow needs a single orbit, not {}", str(orbit.size))
    if not orbit.exists:
        raise NoOrbitError("follow needs an orbit, but there is none: its quantities are NaN")


def _names(orbit: Orbit, along: Any) -> tuple[str, ...]:
    """The one or two parameters along which an orbit is followed."""
    if along is None:
        return orbit.along[:1]
    names = tuple(along) if isinstance(along, list | tuple) else (along,)
    if not all(isinstance(name, str) for name in names):
        raise ParameterError("{along} = {} is not the name of a parameter or two", shortened(along))
    if len(names) not in (1, 2) or len(set(names)) < len(names):
        raise ParameterError(
            "{along} = {} is not one parameter or two different ones", shortened(along)
        )
    balls = Balls(orbit.model, orbit.amplitude)
    for name in names:
        balls.range_of(name)
    return names


def _curve(orbit: Orbit, names: tuple[str, ...], ranges: Any, most: int) -> SpecialCurve:
    """The curve of special orbits of the orbit's kind in two parameters."""
    if not orbit.kind:
        raise NoOrbitError(
            "an ordinary orbit has no curve in two parameters: give a special one, such as "
            'follow(orbit).first("saddle-node")'
        )
    if orbit.kind == Special.GRAZING_IMPACT:
        orbit = grazing.with_one_less(orbit)
    if not isinstance(ranges, Mapping):
        first, second = names
        given = f'such as {{"{first}": (low, high), "{second}": (low, high)}}'
        raise ParameterError("{ranges} = {} is not a range by name, {}", shortened(ranges), given)
    for name in ranges:
        chosen("ranges", name, names)
    first, second = names
    values = Balls(orbit.model, orbit.amplitude).values
    windows = [_window(name, ranges.get(name), float(values[name])) for name in names]
    found = curves.curve_through(
        orbit,
        Special(orbit.kind),
        first,
        second,
        along_window=windows[0],
        across_window=windows[1],
        most=most,
    )
    return SpecialCurve(**labelled(found, "curve", curve_kind=str(orbit.kind)))


def _window(name: str, given: Any, start: float) -> Window | None:
    """The range of a parameter on a curve, which contains its value at the start."""
    if given is None:
        return None
    several = isinstance(given, list | tuple | np.ndarray)
    numbers = [checked_number("ranges", x, Range()) for x in given] if several else []
    if len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise ParameterError(
            f"the range of {name} = {{}} is not two numbers of which the second is larger",
            shortened(given),
        )
    low, high = numbers
    if not low <= start <= high:
        raise ParameterError(
            f"the range {low:g} to {high:g} does not contain {name} = {start:g}, "
            "at which the curve starts"
        )
    return Window(low, high)
