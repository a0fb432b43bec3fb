"""Calls about the n-T orbits of a model: one orbit, the limits of a family, its branch over Λ."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np

from bouncing_ball.beyond.calculator.units import Index
from bouncing_ball.beyond.laws.orbits import law_at_orbit
from bouncing_ball.calls.balls import Positive, impact_model, model, model_of_limits
from bouncing_ball.calls.signatures import check, takes
from bouncing_ball.errors import NoOrbitError, ParameterError, Range, count
from bouncing_ball.numerics.arrays import plain
from bouncing_ball.paper.orbits.model import ImpactModel, labelled
from bouncing_ball.paper.orbits.orbit import Orbit
from bouncing_ball.paper.orbits.stability import Side

Amplitude = Annotated[Any, Range(0, 1e8, "(]")]
Points = Annotated[int, count(10_000, low=10)]


class Limits(NamedTuple):
    """The two orbits that bound the stable range of a family; their values are NaN where the
    bifurcation does not exist.
    """

    saddle_node: Orbit
    period_doubling: Orbit

    def __repr__(self) -> str:
        return f"saddle-node: {self.saddle_node!r}\nperiod doubling: {self.period_doubling!r}"


@takes(model)
def orbit(
    n: Index,
    amplitude: Amplitude,
    *,
    side: Literal["stable", "unstable", "all"] = "stable",
    index: Index | None = None,
    **impact: Any,
) -> Any:
    """The n-T orbit at the excitation amplitude Λ.

    Parameters
    ----------
    n : int or array_like of int
        Index n of the family.
    amplitude : array_like
        Excitation amplitude Λ > 0.
    side : str
        Side of the branch: "stable" or "unstable" next to the saddle-node, or "all" for every
        orbit at this amplitude, in order of contact duration.
    index : int, optional
        Number, from 1, of one orbit in the list of side "all".
    impact
        The parameters of :func:`model`.

    Returns
    -------
    Orbit or Labelled
        One orbit, with Python floats. If a parameter is an array, a dataset of the observables
        of all orbits with an axis named after each array; NaN where there is no orbit.

    Raises
    ------
    NoOrbitError
        If the orbit does not exist; the message gives the reason.
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> orbit(1, 1.0, restitution=0.85, frequency_ratio=10.0)  # doctest: +ELLIPSIS
    SpringDamperOrbit
      n                     1
      law                   SpringDamper(frequency_ratio=10, damping_ratio=0.0516623, ...)
      amplitude             1
      phase                 1.16848
      contact_duration      0.314782
      impact_velocity       -2.99694
      bounce_velocity       2.97147
      apparent_restitution  0.851132
      max_height            5.41098
    """
    check(orbit, locals())
    if _arrays(impact, n, amplitude):
        if side == "all" or index is not None:
            of_one = "{side} all" if side == "all" else "{index}"
            raise ParameterError(f"{of_one} is for one orbit and does not accept arrays")
        grid = labelled().Grid(n=n, amplitude=amplitude, **impact)
        return labelled().orbits(grid, _model_of_orbit, Side(side))
    branch = Side.STABLE if side == "all" else Side(side)
    of = _model_of_orbit(n, amplitude, branch, **impact)
    if side != "all" and index is None:
        return of.require_orbit(n, amplitude, branch)
    if side != "stable" and index is not None:
        raise ParameterError("argument {index}: not allowed with argument {side}")
    found = of.orbits(n, amplitude)
    if not found.size:
        raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {of.label}")
    if index is not None and index > found.size:
        raise NoOrbitError(
            f"no orbit {index}: {of.label} has {found.size} {n}-T orbits at Λ = {amplitude:g}"
        )
    return found if index is None else plain(found[index - 1])


def _model_of_orbit(n: int, amplitude: float, side: Side, **impact: Any) -> ImpactModel:
    """The model for a call about one orbit.

    A contact law that is given by r and D has these values at the impact speed of this orbit.
    """
    return impact_model(impact, lambda kind, r, d: law_at_orbit(kind, r, d, n, amplitude, side))


def _arrays(impact: Mapping[str, Any], *given: Any) -> bool:
    """Whether any argument is an array; ``parameters``, a mapping, is not considered."""
    numbers = (value for name, value in impact.items() if name != "parameters")
    return any(np.ndim(x) > 0 for x in (*given, *numbers))


@takes(model)
def limits(n: Index, **impact: Any) -> Any:
    """Saddle-node and period doubling of the n-T orbits; NaN where there is none.

    Parameters
    ----------
    n : int or array_like of int
        Index n of the family.
    impact
        The parameters of :func:`model`.

    Returns
    -------
    Limits or Labelled
        Two orbits. If a parameter is an array, a dataset of both amplitudes and phases with an
        axis named after each array.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> found = limits(1, restitution=0.85)
    >>> found.saddle_node.amplitude < found.period_doubling.amplitude
    True
    >>> str(found).splitlines()[0]
    'saddle-node: RestitutionOrbit'
    """
    check(limits, locals())
    if _arrays(impact, n):
        return labelled().limits(labelled().Grid(n=n, **impact), model_of_limits)
    of = model_of_limits(n, **impact)
    return Limits(of.saddle_node(n), of.period_doubling(n))


@takes(model)
def branch(
    n: Index, *, amplitude_max: Positive | None = None, points: Points = 300, **impact: Any
) -> Any:
    """The branch of n-T orbits over the amplitude Λ, on both sides of its saddle-node.

    Parameters
    ----------
    n : array_like of int
        Index n of the family.
    amplitude_max : float, optional
        Largest Λ of the branch; by default 1.4 times that of the period doubling.
    points : int
        Number of points along the branch, at equal steps of arclength.
    impact
        The parameters of :func:`bouncing_ball.model`.

    Returns
    -------
    Labelled
        ``amplitude``, ``phase`` and the other observables of each ``point``, and whether the
        orbit is ``stable`` and ``admissible``; ``special_amplitude`` and others of the
        saddle-nodes, period doublings and grazing orbits. Where one of several branches does not
        exist it is NaN, and ``end_reason`` says why.

    Raises
    ------
    NoOrbitError
        If there is no branch up to this Λ, or if it cannot be followed.
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> found = branch(1, restitution=0.85, points=50)
    >>> found.special_kind.values.tolist()
    ['saddle-node', 'period doubling']
    >>> round(float(found.special_amplitude[0]) / np.pi * 1.85 / 0.15, 12)
    1.0
    """
    check(branch, locals())
    grid = labelled().Grid(n=n, **impact)
    return labelled().branches(grid, model_of_limits, amplitude_max, points)
