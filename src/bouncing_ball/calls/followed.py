"""Calls that follow any periodic orbit along any parameter, and its special orbits in two."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np

from bouncing_ball.calls.labelled_branches import FollowedBranch, SpecialCurve
from bouncing_ball.calls.periodic import PeriodicOrbit
from bouncing_ball.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    DAMPING_RATIO,
    FINITE,
    FOLLOWED,
    FREQUENCY_RATIO,
    POINTS,
    RESTITUTION,
    STATE,
    Impacts,
    Points,
    checked_number,
    chosen,
)
from bouncing_ball.errors import ParameterError
from bouncing_ball.models.ball import Ball, a_ball, a_single_ball
from bouncing_ball.models.damping import Release, damping_ratio, restitution_coefficient
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic import curves, following, switching
from bouncing_ball.periodic.curves import Window
from bouncing_ball.periodic.family import AMPLITUDE as LAMBDA
from bouncing_ball.periodic.family import Family, nothing
from bouncing_ball.periodic.following import State
from bouncing_ball.periodic.model import ImpactModel
from bouncing_ball.periodic.special import Special

_RANGES = {
    LAMBDA: AMPLITUDE_OF_ORBIT,
    "frequency_ratio": FREQUENCY_RATIO,
    "restitution": RESTITUTION,
    "damping_ratio": DAMPING_RATIO,
}
BRANCH, CURVE = 500, 500
"""Default of the largest number of points of a branch, and of a curve in each direction."""


def _numbers(law: Any) -> dict[str, float]:
    """The numerical parameters of a law, or of the law inside of a law, by name."""
    found: dict[str, float] = {}
    for field in fields(law):
        value = getattr(law, field.name)
        if is_dataclass(value):
            found |= _numbers(value)
        elif isinstance(value, int | float | np.number) and not isinstance(value, bool):
            found[field.name] = float(value)
    return found


def _with_numbers(law: Any, values: Mapping[str, Any]) -> Any:
    """The law with other values of its parameters."""
    changed: dict[str, Any] = {}
    for field in fields(law):
        inner = getattr(law, field.name)
        if is_dataclass(inner):
            changed[field.name] = _with_numbers(inner, values)
        elif field.name in values:
            changed[field.name] = values[field.name]
    return replace(law, **changed)


def family_of(model: ImpactModel, amplitude: float) -> Family:
    """The balls of a single model, with Λ and the parameters of the law by name.

    A spring and a damper have a restitution coefficient (Eq. 16) beside their damping ratio; of the
    two, that which does not vary follows from the other.

    Examples
    --------
    >>> from bouncing_ball import spring_damper
    >>> family = family_of(spring_damper(frequency_ratio=9.0, damping_ratio=0.0), 1.0)
    >>> dict(family.values)
    {'frequency_ratio': 9.0, 'damping_ratio': 0.0, 'amplitude': 1.0, 'restitution': 1.0}
    """
    values = {**_numbers(model), LAMBDA: amplitude}
    linear = isinstance(getattr(model.impact_law, "law", model.impact_law), SpringDamper)
    if linear:
        zeta = values["damping_ratio"]
        values["restitution"] = float(restitution_coefficient(zeta, Release.DISPLACEMENT))

    return Family(
        make=lambda given: _with_numbers(model, given),
        values=values,
        ranges={name: _RANGES.get(name, FINITE) for name in values},
        implied=_loss if linear else nothing,
    )


def _loss(varied: Mapping[str, Any]) -> dict[str, Any]:
    """ζ of r, or r of ζ, of linear contacts."""
    if "restitution" in varied:
        return {"damping_ratio": damping_ratio(varied["restitution"])}
    if "damping_ratio" in varied:
        zeta = varied["damping_ratio"]
        return {"restitution": restitution_coefficient(zeta, Release.DISPLACEMENT)}
    return {}


def _state(orbit: Any, along: str) -> State:
    """An orbit as the start of a branch along a parameter."""
    if isinstance(orbit, State):
        return orbit.along(along)
    if not isinstance(orbit, PeriodicOrbit):
        how = "orbit, orbit_of_motion, switch or by a branch"
        kind = type(orbit).__name__
        raise ParameterError(f"the orbit, a {kind}, is not one that was made by {how}")
    family = family_of(orbit.model, orbit.amplitude)
    family.bounds(along)
    return switching.of_single_impact(
        family, orbit.phase, orbit.impact_velocity, orbit.contact_duration, orbit.n, along
    )


def orbit_of_motion(
    ball: Ball,
    *,
    amplitude: float,
    phase: float = 0.0,
    velocity: float = -math.pi,
    impacts: Impacts = 4000,
) -> State:
    """The periodic orbit on which a ball ends, as a start for :func:`follow`.

    The parameters are those of :func:`bouncing_ball.motion_of`, for a single ball.

    Raises
    ------
    NoOrbitError
        If the motion does not repeat, or the ball stays on the table; the message gives the reason.
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range.

    Examples
    --------
    >>> from bouncing_ball import rigid
    >>> orbit_of_motion(rigid(restitution=0.5), amplitude=1.6)
    orbit with 2 impacts in 2 periods: amplitude = 1.6
    """
    lam = checked_number("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    phi = checked_number("phase", phase, STATE)
    before = checked_number("velocity", velocity, STATE)
    most = checked_number("impacts", impacts, FOLLOWED)
    family = family_of(a_single_ball(a_ball(ball)), lam)
    return switching.of_motion(family, phi, before, LAMBDA, most)


def follow(
    orbit: PeriodicOrbit | State,
    *,
    along: str = LAMBDA,
    to: float | None = None,
    points: Points = BRANCH,
) -> FollowedBranch:
    """The branch of a periodic orbit along a parameter, up to a value or to the end of the branch.

    Parameters
    ----------
    orbit : PeriodicOrbit or State
        An orbit of :func:`bouncing_ball.orbit`, :func:`orbit_of_motion` or :func:`switch`, or one
        of a branch.
    along : str
        The parameter: "amplitude", or one of the law, such as "frequency_ratio", "damping_ratio",
        "restitution" or the "stiffness" of a contact law.
    to : float, optional
        The value at which the branch ends; by default the parameter rises to the end of its range.
        Behind a saddle-node the parameter moves back, at most as far beyond its first value.
    points : int
        The largest number of points.

    Returns
    -------
    FollowedBranch
        The parameter at each ``point``, ``phase``, ``contact_duration`` and the other observables
        of :func:`bouncing_ball.branch` for each ``impact``, and whether the orbit is ``stable`` and
        ``admissible``; ``special_kind`` and the place of the special orbits; ``end_reason`` says
        why the branch ends.

    Raises
    ------
    NoOrbitError
        If there is no orbit at the start.
    ModelError
        If a parameter is unknown, of a wrong type, or out of range.

    Examples
    --------
    >>> import bouncing_ball
    >>> ball = bouncing_ball.spring_damper(restitution=0.85, frequency_ratio=10.0)
    >>> found = follow(bouncing_ball.orbit(ball, amplitude=1.0), to=1.2)
    >>> found.special_kind.values.tolist(), found.special_amplitude.values.round(6).tolist()
    (['period doubling'], [1.037456])
    >>> str(found.end_reason[1].values)
    'amplitude = 1.2 is reached'
    """
    start = _state(orbit, along)
    most = checked_number("points", points, POINTS)
    value = None if to is None else checked_number("to", to, start.orbits.family.ranges[along])
    return FollowedBranch.of_orbits(following.follow(start, value, most=most), "follow")


def switch(orbit: State) -> State:
    """The first orbit of twice the period, on the branch that begins at a period doubling.

    Parameters
    ----------
    orbit : State
        A period doubling of a branch, such as ``found.first("period doubling")``.

    Raises
    ------
    NoOrbitError
        If no orbit of twice the period is found.

    Examples
    --------
    >>> import bouncing_ball
    >>> one = bouncing_ball.orbit(bouncing_ball.rigid(restitution=0.5), amplitude=1.4)
    >>> two = switch(follow(one, to=1.8).first("period doubling"))
    >>> two.impacts, two.periods
    (2, 2)
    >>> round(float(follow(two, to=1.8).special_amplitude[0]), 6)
    1.667131
    """
    if not isinstance(orbit, State):
        raise ParameterError("switch needs an orbit of a branch, not {}", type(orbit).__name__)
    return switching.switch(orbit)


def curve(
    orbit: State,
    *,
    kind: str,
    across: str,
    along_range: Sequence[float] | None = None,
    across_range: Sequence[float] | None = None,
    points: Points = CURVE,
) -> SpecialCurve:
    """The curve of special orbits in two parameters, through one of them.

    Parameters
    ----------
    orbit : State
        A special orbit of a branch, such as ``found.first("saddle-node")``. The first parameter is
        that of the branch.
    kind : str
        The kind of the special orbit: "saddle-node", "period doubling", "grazing of a flight",
        "grazing of an impact" or "grazing of a release".
    across : str
        The second parameter.
    along_range, across_range : two floats, optional
        The ranges of both parameters outside which the curve is not followed.
    points : int
        The largest number of points in each direction.

    Returns
    -------
    SpecialCurve
        Both parameters at each ``point``, the states of the impacts as for :func:`follow`, and
        ``special_kind`` with the place of each "cusp", "1:1 resonance" and "1:2 resonance".

    Raises
    ------
    NoOrbitError
        If there is no such special orbit.
    ModelError
        If a parameter or the kind is unknown.

    Examples
    --------
    The saddle-nodes of the restitution model are at Λ = π (1 - r)/(1 + r):

    >>> import bouncing_ball
    >>> one = bouncing_ball.orbit(bouncing_ball.rigid(restitution=0.5), amplitude=1.4)
    >>> fold = follow(one, to=0.5).first("saddle-node")
    >>> found = curve(fold, kind="saddle-node", across="restitution", across_range=(0.2, 0.8))
    >>> r = found.restitution
    >>> bool(abs(found.amplitude - np.pi * (1 - r) / (1 + r)).max() < 1e-12)
    True
    """
    if not isinstance(orbit, State):
        raise ParameterError("curve needs an orbit of a branch, not {}", type(orbit).__name__)
    if len(orbit.orbits.along) != 1 or across in orbit.orbits.along:
        raise ParameterError("{across} must be another parameter than that of the branch")
    name = chosen("kind", kind, [str(each) for each in Special])
    most = checked_number("points", points, POINTS)
    family = orbit.orbits.family
    family.bounds(across)
    at = {**family.values, **orbit.parameters}
    along = orbit.orbits.along[0]
    found = curves.curve(
        orbit,
        Special(name),
        across,
        along_window=_window("along_range", along_range, along, at[along]),
        across_window=_window("across_range", across_range, across, at[across]),
        most=most,
    )
    return SpecialCurve.of_orbits(found, "curve", curve_kind=name)


def _window(
    name: str, given: Sequence[float] | None, parameter: str, start: float
) -> Window | None:
    """The range of a parameter on a curve, which contains its value at the start."""
    if given is None:
        return None
    numbers = [checked_number(name, value, FINITE) for value in given]
    if len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise ParameterError(
            f"{{{name}}} = {{}} is not two numbers of which the second is larger", repr(given)
        )
    low, high = numbers
    if not low <= start <= high:
        raise ParameterError(
            f"{{{name}}} = {low:g} to {high:g} does not contain {parameter} = {start:g}, at which "
            "the curve starts"
        )
    return Window(low, high)
