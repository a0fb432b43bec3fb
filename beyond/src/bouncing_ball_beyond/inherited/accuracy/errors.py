r"""The quantities compared, and the relative errors of the restitution model (Eqs. 37 and 38).

The paper compares the greatest height and the threshold of permanent contact of the spring-damper
model (SD) with those of the restitution model (CR)::

    |max z_SD - max z_CR| / max z_CR = 0.01   at ϖ_h,1%      (37)
    |Λ_SD - Λ_CR| / Λ_CR = 0.01               at ϖ_PC,1%     (38)

Here the left sides have a sign, positive where the restitution model predicts less, and the same
error is computed for other quantities.
"""

from collections.abc import Sequence
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models.model import Model
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation


class Quantity(StrEnum):
    """A quantity that is compared between the models.

    The first four are observables of the stable orbit at n and Λ. The others are values of Λ, of
    which the last does not depend on n.
    """

    MAX_HEIGHT = "max_height"
    BOUNCE_VELOCITY = "bounce_velocity"
    PHASE = "phase"
    APPARENT_RESTITUTION = "apparent_restitution"
    SADDLE_NODE = "saddle_node"
    PERIOD_DOUBLING = "period_doubling"
    PERMANENT_CONTACT = "permanent_contact"


_BIFURCATIONS = {
    Quantity.SADDLE_NODE: Bifurcation.SADDLE_NODE,
    Quantity.PERIOD_DOUBLING: Bifurcation.PERIOD_DOUBLING,
}
_OF_ORBIT = {*Quantity} - {*_BIFURCATIONS, Quantity.PERMANENT_CONTACT}


def values(
    model: Model, n: ArrayLike, amplitude: ArrayLike, quantities: Sequence[str]
) -> np.ndarray:
    """Values of quantities in a model, shape (quantity, ...).

    Parameters
    ----------
    model : Model
    n, amplitude : array_like
        Index of the family and Λ of the stable orbits; they broadcast with the model.
    quantities : sequence of str

    Returns
    -------
    ndarray
        NaN where the model has no such orbit or bifurcation.

    Examples
    --------
    >>> found = values(RestitutionModel(0.5), 1, 2.0, ["bounce_velocity", "permanent_contact"])
    >>> bool(np.all(found == [np.pi, 1.0]))
    True
    """
    branch = explicit_branch(model)
    # The orbits and the bifurcations are searched for, so that each is found only if it is asked.
    orbit = branch.orbit(n, amplitude) if _OF_ORBIT.intersection(quantities) else None
    found = []
    for quantity in map(Quantity, quantities):
        if quantity is Quantity.PERMANENT_CONTACT:
            found.append(model.permanent_contact_threshold())
        elif quantity in _BIFURCATIONS:
            found.append(branch.bifurcation(_BIFURCATIONS[quantity], n).amplitude)
        else:
            found.append(getattr(orbit, quantity))
    shape = np.broadcast_shapes(model.shape, np.shape(n), np.shape(amplitude))
    return np.stack([np.broadcast_to(each, shape) for each in found])


def relative_errors(
    exact: SpringDamper,
    simple: RestitutionModel,
    n: ArrayLike,
    amplitude: ArrayLike,
    quantities: Sequence[str],
) -> np.ndarray:
    """The errors (q_SD - q_CR)/q_CR of quantities (Eqs. 37-38), shape (quantity, ...).

    The arguments are those of :func:`values`, with both models.

    Returns
    -------
    ndarray
        NaN where a model has no such orbit or bifurcation. Infinite where the value of the
        restitution model is 0, for example for the saddle-node at r = 1.

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ² above the resonance:

    >>> contact, simple = SpringDamper(2.0, 0.0), RestitutionModel(1.0)
    >>> relative_errors(contact, simple, 1, 1.0, ["permanent_contact"]).tolist()
    [-0.25]
    """
    shape = np.broadcast_shapes(exact.shape, simple.shape, np.shape(n), np.shape(amplitude))
    lam = np.broadcast_to(amplitude, shape)
    base = values(simple, n, lam, quantities)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (values(exact, n, lam, quantities) - base) / base


def modulus(error: ArrayLike) -> np.ndarray:
    """Modulus of errors; infinite for NaN, because a model that lacks a quantity is not accurate.

    Examples
    --------
    >>> modulus([-0.5, np.nan]).tolist()
    [0.5, inf]
    """
    return np.where(np.isnan(error), np.inf, np.abs(error))
