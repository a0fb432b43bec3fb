"""The branch of n-T orbits of either model in closed form, and why it has no orbit at some Λ.

n and Λ are arrays that broadcast with the model; orbits that do not exist have NaN.
"""

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models.model import Model
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Orbit, Side
from bouncing_ball_beyond.inherited.periodic.restitution_branch import RestitutionBranch
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import SpringDamperBranch

ExplicitBranch = RestitutionBranch | SpringDamperBranch
"""A branch in closed form: ``orbit`` at given Λ on one side of the saddle-node, all ``orbits`` at
one Λ, and its ``bifurcation`` of a kind.
"""


def explicit_branch(model: Model) -> ExplicitBranch:
    """The branch of n-T orbits of a model.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> found = explicit_branch(rigid(restitution=1.0)).orbit(1, 0.5)
    >>> round(float(found.phase) / np.pi, 15)
    0.5
    """
    if isinstance(model, RestitutionModel):
        return RestitutionBranch(model)
    if isinstance(model, SpringDamper):
        return SpringDamperBranch(model)
    raise TypeError(f"{type(model).__name__} has no branch in closed form")


class Absence(StrEnum):
    """Why there is no orbit on a side of the branch at some Λ."""

    NONE = "there is one"
    BELOW_SADDLE_NODE = "below the saddle-node"
    NO_OTHER_SIDE = "the branch has no saddle-node and therefore no other side"
    NOT_REACHED = "this side of the branch does not reach this Λ"


def absence(
    branch: ExplicitBranch, n: ArrayLike, amplitude: ArrayLike, side: str = Side.STABLE
) -> np.ndarray:
    """Why a branch has no orbit on a side: the text of an :class:`Absence` for each entry.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> absence(explicit_branch(rigid(restitution=0.5)), 1, [1.0, 1.1]).tolist()
    ['below the saddle-node', 'there is one']
    """
    exists = branch.orbit(n, amplitude, side).exists
    fold = branch.bifurcation(Bifurcation.SADDLE_NODE, n).amplitude
    alone = np.isnan(fold) & (side == Side.UNSTABLE)
    other = np.where(alone, Absence.NO_OTHER_SIDE, Absence.NOT_REACHED)
    why = np.where(np.asarray(amplitude) < fold, Absence.BELOW_SADDLE_NODE, other)
    return np.where(exists, Absence.NONE, why)


def required_orbit(model: Model, n: int, amplitude: float, side: str = Side.STABLE) -> Orbit:
    """The orbit of a single model at Λ on one side of the saddle-node.

    Raises
    ------
    NoOrbitError
        If there is no orbit; the message gives the reason.
    """
    branch = explicit_branch(model)
    found = branch.orbit(n, amplitude, side)
    if not found.exists:
        why = str(absence(branch, n, amplitude, side))
        if why == Absence.BELOW_SADDLE_NODE:
            fold = branch.bifurcation(Bifurcation.SADDLE_NODE, n).amplitude
            why = f"{why} at Λ = {float(fold):.6g}"
        raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {model.label}: {why}")
    return found
