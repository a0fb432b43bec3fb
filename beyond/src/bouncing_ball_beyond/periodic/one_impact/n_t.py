"""The n-T orbits of any model: one impact in n periods of the table.

They follow from the closed form of the model's branch if there is one
(:mod:`~bouncing_ball_beyond.periodic.one_impact.closed_forms`), and otherwise from a search that
starts from the corrected model (:mod:`~bouncing_ball_beyond.periodic.one_impact.searched_orbits`).
A branch of n-T orbits begins at one of these orbits, and :func:`orbits_of` alone decides how it is
found.
"""

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.periodic.orbit import Side
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.periodic.one_impact.closed_forms import (
    CorrectedLine,
    RestitutionLine,
    SpringDamperBranch,
)
from bouncing_ball_beyond.periodic.one_impact.orbits_of_model import OrbitsOfModel
from bouncing_ball_beyond.periodic.one_impact.searched_orbits import SearchedOrbits
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit


class Absence(StrEnum):
    """Why there is no orbit on a side of the branch at some Λ."""

    NONE = "there is one"
    BELOW_SADDLE_NODE = "below the saddle-node"
    NO_OTHER_SIDE = "the branch has no saddle-node and therefore no other side"
    NOT_REACHED = "this side of the branch does not reach this Λ"
    NOT_FOUND = "none was found, but one may exist"


def orbits_of(model: Model) -> OrbitsOfModel:
    """The n-T orbits of a model: its class and its law decide by which formula or search they are
    found.

    Examples
    --------
    >>> orbits_of(RestitutionModel(0.5))
    RestitutionLine(model=RestitutionModel(restitution=0.5))
    """
    if isinstance(model, RestitutionModel):
        return RestitutionLine(model)
    if isinstance(model, ContactModel) and model.law.is_linear_and_underdamped:
        return SpringDamperBranch(model)
    if isinstance(model, CorrectedModel) and model.law.is_constant:
        return CorrectedLine(model)
    return SearchedOrbits(model)


def orbit(model: Model, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> Orbit:
    """The n-T orbits at given Λ, on one side of the saddle-node.

    Parameters
    ----------
    model : Model
    n : array_like of int
        Index of the family: an orbit repeats after the time 2πn.
    amplitude : array_like
        Λ = aΩ²/g.
    side : Side
        The side of the branch that is stable next to the saddle-node, or the other side.

    Returns
    -------
    Orbit
        Has the shape to which n, Λ and the model broadcast; NaN where there is no orbit.

    Raises
    ------
    ModelError
        If n is not a positive integer, or the side is unknown.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> round(orbit(RestitutionModel(1.0), 1, 0.5).phase / np.pi, 15)
    0.5
    """
    return orbits_of(model).orbit(n, amplitude, Side(side))


def orbits(model: Model, n: int, amplitude: float) -> Orbit:
    """All n-T orbits of a single model at one Λ, in order of contact duration, shape (count,).

    Without a closed form these are the orbits on the branch that comes from large Λ. If this branch
    cannot be followed, they are the orbits on both sides of the saddle-node.

    Raises
    ------
    ModelError
        If n is not a positive integer.
    """
    return orbits_of(model).orbits(n, amplitude)


def saddle_node(model: Model, n: ArrayLike) -> Orbit:
    """The orbits at the saddle-node, with the shape of n and the model; NaN where none exists.

    Raises
    ------
    ModelError
        If n is not a positive integer.
    """
    return orbits_of(model).saddle_node(n)


def period_doubling(model: Model, n: ArrayLike) -> Orbit:
    """The orbits at the period doubling that is nearest to the saddle-node on the stable side.

    They have the shape of n and the model; NaN where the stable side has no period doubling.

    Raises
    ------
    ModelError
        If n is not a positive integer.
    """
    return orbits_of(model).period_doubling(n)


def absence(
    model: Model, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
) -> np.ndarray:
    """Why :func:`orbit` finds no orbit: the text of an :class:`Absence` for each entry.

    Arguments and shape are those of :func:`orbit`.
    """
    missing = ~np.asarray(orbit(model, n, amplitude, side).exists)
    fold = np.asarray(saddle_node(model, n).amplitude)
    other = Absence.NOT_FOUND
    if orbits_of(model).is_complete:
        no_fold = np.isnan(fold) & (side == Side.UNSTABLE)
        other = np.where(no_fold, Absence.NO_OTHER_SIDE, Absence.NOT_REACHED)
    why = np.where(np.asarray(amplitude) < fold, Absence.BELOW_SADDLE_NODE, other)
    return np.where(missing, why, Absence.NONE)


def require_orbit(model: Model, n: int, amplitude: float, side: Side = Side.STABLE) -> Orbit:
    """The orbit of a single model at Λ on one side of the saddle-node.

    Raises
    ------
    NoOrbitError
        If there is no orbit; the message gives the reason.
    """
    found = orbit(model, n, amplitude, side)
    if not found.exists:
        why = str(absence(model, n, amplitude, side))
        if why == Absence.BELOW_SADDLE_NODE:
            why = f"{why} at Λ = {saddle_node(model, n).amplitude:.6g}"
        raise NoOrbitError(f"no {n}-T orbit at Λ = {amplitude:g} for {model.label}: {why}")
    return found
