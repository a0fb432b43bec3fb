"""The periodic orbits of a ball: an n-T orbit, all of them at an amplitude, the limits of a family,
and orbits with several impacts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import wraps
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    FAMILY,
    START,
    AmplitudeOfOrbit,
    AmplitudeOfOrbitAxis,
    FamilyAxis,
    SideName,
    checked,
    checked_number,
    chosen,
    is_array,
)
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError, count, suggesting
from bouncing_ball_beyond.inherited.models import permanent_contact as underdamped
from bouncing_ball_beyond.inherited.periodic import calls
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES, Bifurcation, Side
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.docstrings import as_in
from bouncing_ball_beyond.models.given_ball import a_ball, a_known_ball, a_single_ball
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.k_impacts import found_orbits, orbit_from
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

if TYPE_CHECKING:
    from bouncing_ball_beyond.drawing.result import Result

_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")

IMPACTS = count(100)
"""The range of the number of impacts of an orbit that is sought."""


class TwoLimits(NamedTuple):
    """The inherited :class:`~bouncing_ball_beyond.inherited.periodic.calls.TwoLimits`, with orbits
    of this house."""

    saddle_node: Orbit
    period_doubling: Orbit

    def __repr__(self) -> str:
        return f"saddle-node: {self.saddle_node!r}\nperiod doubling: {self.period_doubling!r}"


def _pointing_to_orbits(call: Callable[_Given, _Found]) -> Callable[_Given, _Found]:
    """A call that says who finds orbits with several impacts."""

    @wraps(call)
    def checked(*given: _Given.args, **named: _Given.kwargs) -> _Found:
        if "impacts" in named or "periods" in named:
            raise TypeError(
                "orbit() finds an n-T orbit, with one impact: orbits() finds those with several "
                "impacts and periods"
            )
        return call(*given, **named)

    return checked


@_pointing_to_orbits
@suggesting
@as_in(calls.orbit)
def orbit(
    ball: Ball, n: FamilyAxis = 1, *, amplitude: AmplitudeOfOrbitAxis, side: SideName = "stable"
) -> Orbit | Result:
    """The n-T orbit of a ball of any model at the excitation amplitude Λ.

    Parameters
    ----------
    ball : Ball

    Examples
    --------
    >>> from bouncing_ball_beyond import spring_damper
    >>> orbit(spring_damper(restitution=0.85, frequency_ratio=10.0), amplitude=1.0)
    Orbit
      n                     1
      law                   SpringDamper(frequency_ratio=10, damping_ratio=0.0516623, \
release='displacement')
      amplitude             1
      phase                 1.16848
      contact_duration      0.314782
      impact_velocity       -2.99694
      bounce_velocity       2.97147
      apparent_restitution  0.851132
      max_height            5.41098
    """
    family = checked("n", n, FAMILY)
    lam = checked("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    branch_side = Side(chosen("side", side, list(Side)))
    given = a_ball(ball)
    if _is_grid(given, family, lam):
        # Imported here, because a single orbit needs no labels, and importing xarray takes longer
        # than computing the orbit.
        from bouncing_ball_beyond.periodic.branches.observables import columns
        from bouncing_ball_beyond.periodic.places import dataset_of_places

        names = [name for name in OBSERVABLES if name != "amplitude"]

        def found(one: Ball, n: Any, amplitude: Any) -> dict[str, Any]:
            model = one.at_orbit(n, amplitude, branch_side)
            return columns(n_t.orbit(model, n, amplitude, branch_side), *names)

        none = columns(Orbit.of(RestitutionModel(1.0), 1, 1.0, np.nan), *names)
        return dataset_of_places("orbit", given, {"n": family, "amplitude": lam}, found, none)
    model = given.at_orbit(family, lam, branch_side)
    return n_t.require_orbit(model, family, lam, branch_side)


@suggesting
@as_in(calls.orbits)
def orbits(
    ball: Ball,
    n: Annotated[int, FAMILY] = 1,
    *,
    amplitude: AmplitudeOfOrbit,
    impacts: Annotated[int, IMPACTS] = 1,
    periods: Annotated[int, FAMILY] | None = None,
) -> list[Orbit]:
    """The periodic orbits of a ball of any model at one Λ with k impacts in m periods.

    With one impact they are the n-T orbits, in order of contact duration, also those that no ball
    follows. If a closed form of the branch is known, as for ``rigid``, ``spring_damper`` and the
    corrected model of a linear contact, these are all of them, except those in which a ball comes
    to rest on the table. For another law they are those on the branch that comes from large Λ, and
    others may exist.

    With several impacts they are those that a ball follows, stable and unstable, from the highest
    to the lowest, as far as Newton's method finds them from a grid of first impacts. Others may
    exist, above all among orbits with large multipliers. Orbits in which a ball comes to rest on
    the table are not sought.

    Parameters
    ----------
    ball : Ball
        A single ball.
    impacts : int
        k, the number of impacts.
    periods : int, optional
        m, the number of periods of the table; by default n.

    Examples
    --------
    A compliant contact has a second stable orbit, of long contact:

    >>> from bouncing_ball_beyond import rigid, spring_damper
    >>> found = orbits(spring_damper(restitution=0.85, frequency_ratio=2.0), amplitude=0.9)
    >>> [(round(each.contact_duration, 3), each.is_stable()) for each in found]
    [(1.602, True), (2.249, False), (5.182, True)]

    Two orbits with three impacts in three periods, of which one is stable:

    >>> found = orbits(rigid(restitution=0.5), impacts=3, periods=3, amplitude=1.6)
    >>> [(round(each.max_height, 3), each.is_stable()) for each in found]
    [(8.209, True), (8.007, False)]
    """
    family = checked_number("n", n, FAMILY)
    if periods is not None:
        given = checked_number("periods", periods, FAMILY)
        if family not in (1, given):
            raise ParameterError("n and {periods} are the same number: give one of them")
        family = given
    k = checked_number("impacts", impacts, IMPACTS)
    lam = checked_number("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    if k > 1:
        model = a_single_ball(ball)
        several = found_orbits(model, k, family, lam)
        if not several:
            raise NoOrbitError(
                f"no orbit with {k} impacts in {family} T was found at Λ = {lam:g} for "
                f"{model.label}, but one may exist"
            )
        return several
    model = a_single_ball(a_ball(ball).at_orbit(family, lam))
    found = n_t.orbits(model, family, lam)
    if not found.size:
        raise NoOrbitError(f"no {family}-T orbit at Λ = {lam:g} for {model.label}")
    return [found[k] for k in range(found.size)]


@suggesting
@as_in(calls.orbits)
def orbit_near(
    ball: Ball, *, amplitude: AmplitudeOfOrbit, phases: ArrayLike, velocities: ArrayLike
) -> Orbit:
    """The periodic orbit of a ball of any model near a guess of its impacts.

    Parameters
    ----------
    ball : Ball
        A single ball.
    phases, velocities : array of k numbers
        The table's phases φ at the impacts, and the absolute velocities z′ before them. A ball that
        begins with each of them must bounce; the number of periods follows from its flight.

    Returns
    -------
    Orbit
        An orbit with k impacts that a ball follows.

    Raises
    ------
    NoOrbitError
        If Newton's method finds none from there.
    ModelError
        If a parameter is an array, of a wrong type, or out of range, or if there are not as many
        phases as velocities.

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> guess = {"phases": [0.4, 1.2], "velocities": [-2.9, -3.4]}
    >>> found = orbit_near(rigid(restitution=0.5), amplitude=1.6, **guess)
    >>> found.periods, found.phase.round(6).tolist()
    (2, [0.403915, 1.194348])
    """
    lam = checked_number("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    starts = np.atleast_1d(np.asarray(checked("phases", phases, START), dtype=float))
    before = np.atleast_1d(np.asarray(checked("velocities", velocities, START), dtype=float))
    if starts.shape != before.shape:
        raise ParameterError(
            f"{{velocities}} has {{}} entries, and there are as many as phases: {starts.size}",
            str(before.size),
        )
    return orbit_from(a_single_ball(ball), lam, starts, before)


@suggesting
@as_in(calls.limits)
def limits(ball: Ball, n: FamilyAxis = 1) -> TwoLimits | Result:
    """Saddle-node and period doubling of the n-T orbits of a ball of any model; NaN where there is
    none.

    Parameters
    ----------
    ball : Ball

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> limits(rigid(restitution=0.85)).saddle_node.kind
    'saddle-node'
    """
    family = checked("n", n, FAMILY)
    given = a_ball(ball)
    if _is_grid(given, family):
        from bouncing_ball_beyond.periodic.places import dataset_of_places

        return dataset_of_places("limits", given, {"n": family}, _both_limits)
    model = given.at_limits(family)
    fold = n_t.saddle_node(model, family)
    doubling = n_t.period_doubling(model, family)
    return TwoLimits(
        saddle_node=replace(fold, kind=str(Bifurcation.SADDLE_NODE)),
        period_doubling=replace(doubling, kind=str(Bifurcation.PERIOD_DOUBLING)),
    )


@suggesting
@as_in(underdamped.permanent_contact)
def permanent_contact(ball: Ball) -> float | Result:
    """The Λ up to which a ball of any model stays on the table if it rests there.

    Parameters
    ----------
    ball : Ball
        A ball whose model is known without a speed.

    Raises
    ------
    ModelError
        If a contact law depends on a speed that is not given.

    Examples
    --------
    >>> from bouncing_ball_beyond import contact_law
    >>> permanent_contact(contact_law("linear", frequency_ratio=1.0, damping_ratio=2.0))
    4.0
    """
    known = a_known_ball(ball)
    if _is_grid(known):
        from bouncing_ball_beyond.periodic.places import dataset_of_places

        return dataset_of_places("permanent-contact", known, {}, _threshold)
    return float(known.permanent_contact_threshold())


def _is_grid(ball: Ball, *arguments: Any) -> bool:
    """Whether an argument or a parameter of the ball is an array."""
    return any(is_array(value) for value in (*arguments, *ball.parameters.values()))


def _both_limits(ball: Ball, n: Any) -> dict[str, Any]:
    """Amplitude and phase of the saddle-node and of the period doubling."""
    model = ball.at_limits(n)
    ends = {
        "saddle_node": n_t.saddle_node(model, n),
        "period_doubling": n_t.period_doubling(model, n),
    }
    return {
        f"{name}_{quantity}": getattr(end, quantity)
        for name, end in ends.items()
        for quantity in ("amplitude", "phase")
    }


def _threshold(model: Model) -> dict[str, Any]:
    return {"threshold_amplitude": model.permanent_contact_threshold()}
