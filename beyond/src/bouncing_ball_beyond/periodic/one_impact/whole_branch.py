"""The branch of n-T orbits of a model, followed from one end to the other.

The branch is a solution curve of the equations of n-T orbits in the unknowns of the paper
(:mod:`bouncing_ball_beyond.periodic.one_impact.paper_unknowns`), with Λ as the parameter. It is
followed to both sides from an orbit in the stable range, until the orbits end or Λ leaves a window.
Where an event cannot be located, for example next to permanent contact, the branch is kept up to
there, and its end says which event it is; such an end is not finished
(:class:`~bouncing_ball.numerics.branch.End`).
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.branch import ContinuationError, EndKind
from bouncing_ball.numerics.events import Event
from bouncing_ball.numerics.steps import StepControl
from bouncing_ball.periodic.orbit import Bifurcation
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.branches.following import Followed, branches_through_points
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.orbits.balls import LOWEST
from bouncing_ball_beyond.periodic.orbits.ends import Window, ends_of_one_impact
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.special import passed_by

LARGEST_STEP = 0.1
"""Default of the largest step in arclength."""
# By default a branch ends at this multiple of the Λ of its period doubling.
_BEYOND_DOUBLING = 1.4
# Number of Λ at which an orbit to start from is searched.
_STARTS = 16

NoBranch = NoOrbitError | ContinuationError
"""Why there is no branch, as an error that is a value."""


def whole_branch(
    model: Model,
    n: int,
    amplitude_max: float | None,
    largest_step: float = LARGEST_STEP,
    ends: Collection[Bifurcation] = (),
) -> Followed:
    """The branch of n-T orbits of a single model, from one end to the other, up to some Λ.

    It is followed to both sides from the orbit in the middle of the stable range, or from the
    orbit at the nearest Λ that has one.

    Parameters
    ----------
    model : Model
    n : int
        Index of the family.
    amplitude_max : float, optional
        Λ at which the branch ends; by default 1.4 times that of the period doubling.
    largest_step : float
        Largest step in arclength.
    ends : collection of Bifurcation, optional
        The bifurcations at which the branch is not followed any further.

    Returns
    -------
    Followed
        The branch in the unknowns of the paper.

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if no orbit is found to start from.
    ContinuationError
        If the branch has more points than are allowed before its end or a bound of Λ.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> found = whole_branch(RestitutionModel(0.85), 1, 1.2, largest_step=0.1)
    >>> [(str(each.kind), round(each.amplitude, 4)) for each in found.special]
    [('saddle-node', 0.2547), ('period doubling', 1.0383)]
    >>> str(found.branch.end)
    'amplitude = 1.2 is reached'
    """
    top = amplitude_max or _default_top(model, n)
    (found,) = whole_branches(model, [n], top, largest_step, ends)
    if isinstance(found, Followed):
        return found
    raise found


def whole_branches(
    model: Model,
    n: ArrayLike,
    amplitude_max: float,
    largest_step: float = LARGEST_STEP,
    ends: Collection[Bifurcation] = (),
) -> list[Followed | NoBranch]:
    """The branches of a row of models, side by side, each as of :func:`whole_branch`.

    Parameters
    ----------
    model : Model
        A row of models, or a single model for all families.
    n : array_like of int, shape (branches,)
        Index of the family of each branch.
    amplitude_max : float
        Λ at which all branches end.
    largest_step, ends
        As for :func:`whole_branch`.

    Returns
    -------
    list of Followed
        With the error of :func:`whole_branch` in place of a branch that cannot be followed.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> found = whole_branches(RestitutionModel(0.85), [1, 2], 1.2)
    >>> [round(each.special[0].amplitude, 4) for each in found]
    [0.2547, 0.5094]
    """
    starts = starts_of_branches(model, n, amplitude_max)
    return branches_through(starts, amplitude_max, largest_step, ends)


def starts_of_branches(model: Model, n: ArrayLike, amplitude_max: float) -> Orbit:
    """The orbits from which :func:`whole_branches` starts, of its parameters, as a row.

    There is no orbit, with NaN in its place, where none was found up to the largest Λ.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> starts_of_branches(RestitutionModel(0.85), [1, 8], 1.2).exists.tolist()
    [True, False]
    """
    family = np.array(n)
    low = _lowest(model, family)
    doubling = np.atleast_1d(n_t.period_doubling(model, family).amplitude)
    begins = low < amplitude_max
    found = _starts(model, family, np.where(begins, low, 0.0), doubling, amplitude_max)
    return Orbit.of(
        found.model,
        family,
        found.amplitude,
        np.where(begins, found.phase, np.nan),
        found.contact_duration,
        found.impact_velocity,
    )


def branches_through(
    starts: Orbit, amplitude_max: float, largest_step: float, ends: Collection[Bifurcation] = ()
) -> list[Followed | NoBranch]:
    """The branches through a row of n-T orbits; the other arguments and the result are as for
    :func:`whole_branches`.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> starts = n_t.orbit(RestitutionModel(0.85), 1, np.array([1.0]))
    >>> (found,) = branches_through(starts, 1.2, LARGEST_STEP)
    >>> str(found.special[0].kind), round(found.special[0].amplitude, 4)
    ('saddle-node', 0.2547)
    """
    problem = PaperUnknowns.of(starts)

    def events(equations: OrbitEquations) -> list[Event]:
        met = [*passed_by(equations), *ends_of_one_impact(equations)]
        return [replace(each, terminal=each.terminal or each.name in ends) for each in met]

    found = branches_through_points(
        problem,
        list(problem.point(starts)),
        events,
        Window(LOWEST, amplitude_max),
        control=StepControl(largest=largest_step),
    )
    return [
        _up_to_its_ends(each) if starts.exists[k] else _no_start(starts[k], amplitude_max)
        for k, each in enumerate(found)
    ]


def _no_start(missing: Orbit, amplitude_max: float) -> NoOrbitError:
    """Why there is no orbit to start from."""
    none = f"no {missing.n}-T orbit up to Λ = {amplitude_max:g} for {missing.model.label}"
    lowest = float(_lowest(missing.model, missing.n)[0])
    if lowest >= amplitude_max:
        return NoOrbitError(f"{none}: the branch begins at Λ = {lowest:.6g}")
    return NoOrbitError(f"{none} was found to start from")


def _lowest(model: Model, n: ArrayLike) -> np.ndarray:
    """Λ at the saddle-nodes of families, or 0 without one, as a row."""
    fold = np.atleast_1d(n_t.saddle_node(model, n).amplitude)
    return np.where(fold > 0, fold, 0.0)


def _up_to_its_ends(found: Followed | ContinuationError) -> Followed | ContinuationError:
    """A branch, or an error if it is not followed to its ends."""
    if isinstance(found, Followed):
        for end in (found.branch.start, found.branch.end):
            if end.kind is EndKind.POINTS:
                return ContinuationError(f"the branch is not followed to its end: {end}")
    return found


def _default_top(model: Model, n: int) -> float:
    """The largest Λ if none is given; without a period doubling it follows from the fold, and
    without a fold from the threshold of permanent contact, with which the orbits merge.
    """
    fold = n_t.saddle_node(model, n).amplitude
    doubling = n_t.period_doubling(model, n).amplitude
    low = fold if fold > 0 else 0.0
    if doubling > low:
        return _BEYOND_DOUBLING * doubling
    begins = 2 * low if low > 0 else model.permanent_contact_threshold()
    return _BEYOND_DOUBLING * float(np.fmax(begins, 1.0))


def _starts(
    model: Model, n: np.ndarray, low: np.ndarray, doubling: np.ndarray, top: float
) -> Orbit:
    """The orbit of each family in the middle of its stable range, or at the nearest of several Λ
    that has one, of the shape of n.
    """
    stable = np.minimum(doubling, top)
    middle = (low + np.where(stable > low, stable, top)) / 2
    others = np.linspace(low, top, _STARTS + 1, axis=-1)[:, 1:]
    nearest_first = np.argsort(np.abs(others - middle[:, np.newaxis]), axis=-1)
    others = np.take_along_axis(others, nearest_first, axis=-1)
    amplitude = np.concatenate([middle[:, np.newaxis], others], axis=-1)
    of_rows = model[:, np.newaxis] if model.shape else model
    orbits = n_t.orbit(of_rows, n[:, np.newaxis], amplitude)
    first = np.argmax(orbits.exists, axis=-1)
    return orbits[np.arange(n.size), first]
