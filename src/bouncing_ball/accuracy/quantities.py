"""The seven quantities by which models are compared, and their values in a model."""

from collections.abc import Iterable
from enum import StrEnum
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.stability import Bifurcation


class Quantity(StrEnum):
    """A quantity that is compared between models."""

    MAX_HEIGHT = "max_height"
    BOUNCE_VELOCITY = "bounce_velocity"
    PHASE = "phase"
    APPARENT_RESTITUTION = "apparent_restitution"
    SADDLE_NODE = "saddle_node"
    PERIOD_DOUBLING = "period_doubling"
    PERMANENT_CONTACT = "permanent_contact"


OF_ORBITS = tuple(Quantity)[:4]
"""Quantities of an orbit: functions of the contact, n and Λ."""
OF_LIMITS = tuple(Quantity)[4:]
"""Values of Λ: functions of the contact and of n; the permanent contact does not depend on n."""
OF_IMPACTS = tuple(Quantity)[:6]
"""Quantities that depend on an impact: all except the permanent contact, which has no impact."""
QUANTITIES = {
    Quantity.MAX_HEIGHT: "greatest height",
    Quantity.BOUNCE_VELOCITY: "bouncing-off velocity",
    Quantity.PHASE: "phase of impact",
    Quantity.APPARENT_RESTITUTION: "apparent restitution",
    Quantity.SADDLE_NODE: str(Bifurcation.SADDLE_NODE),
    Quantity.PERIOD_DOUBLING: str(Bifurcation.PERIOD_DOUBLING),
    Quantity.PERMANENT_CONTACT: "threshold of permanent contact",
}
"""The names of the quantities in sentences."""


def values(
    model: ImpactModel, n: ArrayLike, amplitude: ArrayLike, quantities: Iterable[str] = OF_IMPACTS
) -> np.ndarray:
    """Values of quantities in a model; one search for the orbit serves all its quantities.

    Parameters
    ----------
    model : ImpactModel
    n, amplitude : array_like
        Index of the family and Λ of the stable orbits; they broadcast with the model.
    quantities : iterable of str

    Returns
    -------
    ndarray, shape (quantity, ...)
        NaN where the model has no such orbit or bifurcation.

    Examples
    --------
    >>> from bouncing_ball.orbits.restitution_model import RestitutionModel
    >>> names = "bounce_velocity", "permanent_contact"
    >>> bool(np.all(values(RestitutionModel(0.5), 1, 2.0, names) == [np.pi, 1.0]))
    True
    """
    orbit = cache(lambda: model.orbit(n, amplitude))

    def value(quantity: str) -> np.ndarray:
        if quantity == Quantity.PERMANENT_CONTACT:
            return model.permanent_contact_threshold()
        if quantity in OF_LIMITS:
            return getattr(model, quantity)(n).amplitude
        return getattr(orbit(), quantity)

    return np.stack(np.broadcast_arrays(*map(value, quantities)))
