"""The branch of n-T orbits of a model, followed from one end to the other.

The branch is a solution curve of the equations of n-T orbits in the unknowns of the paper
(:mod:`bouncing_ball_beyond.periodic.one_impact.paper_unknowns`), with Λ as the parameter. It is
followed to both sides from an orbit in the stable range, until the orbits end or Λ leaves a window.
Where an event cannot be located, for example next to permanent contact, the branch is kept up to
there, and its end says which event it is; such an end is not finished
(:class:`~bouncing_ball_beyond.inherited.numerics.branch.End`).
"""

import numpy as np

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.branch import ContinuationError, EndKind
from bouncing_ball_beyond.inherited.numerics.steps import StepControl
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.branches.following import Followed, branches_through_points
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.orbits.balls import LOWEST
from bouncing_ball_beyond.periodic.orbits.ends import Window, ends_of_one_impact
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.special import passed_by

LARGEST_STEP = 0.1
"""Default of the largest step in arclength."""
# By default a branch ends at this multiple of the Λ of its period doubling.
_BEYOND_DOUBLING = 1.4
# Number of Λ at which an orbit to start from is searched.
_STARTS = 16


def whole_branch(
    model: Model,
    n: int,
    amplitude_max: float | None,
    largest_step: float = LARGEST_STEP,
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
    start = _start(model, n, top)
    problem = PaperUnknowns.of(start)
    (found,) = branches_through_points(
        problem,
        [problem.point(start)],
        lambda equations: [*passed_by(equations), *ends_of_one_impact(equations)],
        Window(LOWEST, top),
        control=StepControl(largest=largest_step),
    )
    if isinstance(found, ContinuationError):
        raise found
    for end in (found.branch.start, found.branch.end):
        if end.kind is EndKind.POINTS:
            raise ContinuationError(f"the branch is not followed to its end: {end}")
    return found


def _default_top(model: Model, n: int) -> float:
    """The largest Λ if none is given; without a period doubling it follows from the fold, and
    without a fold from the threshold of permanent contact, with which the orbits merge.
    """
    low = _lowest(model, n)
    doubling = n_t.period_doubling(model, n).amplitude
    if doubling > low:
        return _BEYOND_DOUBLING * doubling
    begins = 2 * low if low > 0 else model.permanent_contact_threshold()
    return _BEYOND_DOUBLING * float(np.fmax(begins, 1.0))


def _lowest(model: Model, n: int) -> float:
    """Λ at the saddle-node, or 0 without one."""
    fold = n_t.saddle_node(model, n).amplitude
    return fold if fold > 0 else 0.0


def _start(model: Model, n: int, top: float) -> Orbit:
    """The orbit in the middle of the stable range, or at the nearest of several Λ that has one.

    Raises
    ------
    NoOrbitError
        If there is none up to the largest Λ.
    """
    none = f"no {n}-T orbit up to Λ = {top:g} for {model.label}"
    low = _lowest(model, n)
    if low >= top:
        raise NoOrbitError(f"{none}: the branch begins at Λ = {low:.6g}")
    stable = np.minimum(n_t.period_doubling(model, n).amplitude, top)
    middle = (low + (stable if stable > low else top)) / 2
    others = np.linspace(low, top, _STARTS + 1)[1:]
    nearest_first = others[np.argsort(np.abs(others - middle))]
    orbits = n_t.orbit(model, n, np.array([middle, *nearest_first]))
    if not orbits.exists.any():
        raise NoOrbitError(f"{none} was found to start from")
    return orbits[int(np.argmax(orbits.exists))]
