"""The calls ``orbit``, ``orbits`` and ``limits``: the n-T orbits of a ball."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    FAMILY,
    AmplitudeOfOrbit,
    AmplitudeOfOrbitAxis,
    FamilyAxis,
    SideName,
    checked,
    checked_number,
    chosen,
    is_array,
)
from bouncing_ball_beyond.inherited.errors import NoOrbitError, suggesting
from bouncing_ball_beyond.inherited.models.model import Model, a_ball, a_single_ball
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch, required_orbit
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES, Bifurcation, Orbit, Side

if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid
    from bouncing_ball_beyond.inherited.drawing.result import Result


class TwoLimits(NamedTuple):
    """The two orbits that bound the stable range of a family; their numbers are NaN where the
    bifurcation does not exist.
    """

    saddle_node: Orbit
    period_doubling: Orbit

    def __repr__(self) -> str:
        return f"saddle-node: {self.saddle_node!r}\nperiod doubling: {self.period_doubling!r}"


@suggesting
def orbit(
    ball: Model, n: FamilyAxis = 1, *, amplitude: AmplitudeOfOrbitAxis, side: SideName = "stable"
) -> Orbit | Result:
    """The n-T orbit at the excitation amplitude Λ.

    Parameters
    ----------
    ball : Model
    n : int or array of int
        Index n of the family.
    amplitude : float or array
        Excitation amplitude Λ > 0.
    side : str
        Side of the branch next to the saddle-node: "stable" or "unstable".

    Returns
    -------
    Orbit or Result
        One orbit. If a parameter is an array, a dataset of the observables of all orbits with an
        axis named after each array; NaN where there is no orbit.

    Raises
    ------
    NoOrbitError
        If the single orbit does not exist; the message gives the reason.
    ModelError
        If a parameter is of a wrong type or shape, or out of range.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import spring_damper
    >>> orbit(spring_damper(restitution=0.85, frequency_ratio=10.0), amplitude=1.0)
    Orbit
      n                     1
      model                 SpringDamper(frequency_ratio=10, damping_ratio=0.0516623, \
release='displacement')
      amplitude             1
      phase                 1.16848
      contact_duration      0.314782
      impact_velocity       -2.99694
      bounce_velocity       2.97147
      apparent_restitution  0.851132
      max_height            5.41098
      stable                True
      admissible            True
    """
    family = checked("n", n, FAMILY)
    lam = checked("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    branch_side = Side(chosen("side", side, list(Side)))
    grid = _grid(ball, n=family, amplitude=lam)
    if grid is None:
        return required_orbit(ball, family, lam, branch_side)
    from bouncing_ball_beyond.inherited.drawing.result import Result

    families = grid.row("n")
    amplitudes = grid.row("amplitude")
    found = explicit_branch(ball.row(grid)).orbit(families, amplitudes, branch_side)
    names = [name for name in OBSERVABLES if name != "amplitude"]
    columns = {name: getattr(found, name) for name in (*names, "stable", "admissible")}
    return Result.on_grid(grid, columns, "orbit")


@suggesting
def orbits(
    ball: Model, n: Annotated[int, FAMILY] = 1, *, amplitude: AmplitudeOfOrbit
) -> list[Orbit]:
    """All n-T orbits at one excitation amplitude Λ, in order of contact duration.

    Parameters
    ----------
    ball : Model
        A single ball.
    n : int
        Index n of the family.
    amplitude : float
        Excitation amplitude Λ > 0.

    Returns
    -------
    list of Orbit
        Whether each is ``stable`` and ``admissible`` is among its numbers. On a stiff contact,
        nϖ > 600, those of the longest contacts are not searched: a contact that lasts for a
        hundred of its free oscillations is no impact.

    Raises
    ------
    NoOrbitError
        If there is none.
    ModelError
        If a parameter is an array, of a wrong type, or out of range.

    Examples
    --------
    A compliant contact has a second stable orbit, of long contact:

    >>> from bouncing_ball_beyond.inherited import spring_damper
    >>> found = orbits(spring_damper(restitution=0.85, frequency_ratio=2.0), amplitude=0.9)
    >>> [(round(float(each.contact_duration), 3), bool(each.stable)) for each in found]
    [(1.602, True), (2.249, False), (5.182, True)]
    """
    family = checked_number("n", n, FAMILY)
    lam = checked_number("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    model = a_single_ball(ball)
    found = explicit_branch(model).orbits(family, lam)
    if not found.size:
        raise NoOrbitError(f"no {family}-T orbit at Λ = {lam:g} for {model.label}")
    return [found[k] for k in range(found.size)]


@suggesting
def limits(ball: Model, n: FamilyAxis = 1) -> TwoLimits | Result:
    """Saddle-node and period doubling of the n-T orbits; NaN where there is none.

    Parameters
    ----------
    ball : Model
    n : int or array of int
        Index n of the family.

    Returns
    -------
    TwoLimits or Result
        Two orbits. If a parameter is an array, a dataset of both amplitudes and phases with an
        axis named after each array.

    Raises
    ------
    ModelError
        If n is no whole number in its range.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = limits(rigid(restitution=0.85))
    >>> [round(float(each.amplitude), 6) for each in found]
    [0.254724, 1.038304]
    """
    family = checked("n", n, FAMILY)
    grid = _grid(ball, n=family)
    if grid is None:
        branch = explicit_branch(ball)
        return TwoLimits(*(branch.bifurcation(kind, family) for kind in Bifurcation))
    from bouncing_ball_beyond.inherited.drawing.result import Result

    branch = explicit_branch(ball.row(grid))
    columns = {}
    for kind in Bifurcation:
        found = branch.bifurcation(kind, grid.row("n"))
        columns[f"{kind.name.lower()}_amplitude"] = found.amplitude
        columns[f"{kind.name.lower()}_phase"] = found.phase
    return Result.on_grid(grid, columns, "limits")


def _grid(ball: Any, **arguments: Any) -> Grid | None:
    """The grid that the arguments and the parameters of a ball span; None if all are numbers."""
    parameters = a_ball(ball).parameters
    if not any(is_array(value) for value in (*arguments.values(), *parameters.values())):
        return None
    # Imported here, because a single orbit needs no labels, and importing xarray takes longer than
    # computing the orbit.
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid

    return Grid(**arguments, **parameters)
