"""Errors of the restitution model and of the corrected model on linear contacts, and the
thresholds above which each of them is accurate.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.accuracy.errors import (
    OF_IMPACTS,
    OF_ORBITS,
    relative,
    relative_errors,
    values,
)
from bouncing_ball.accuracy.thresholds import (
    by_quantity,
    last_crossing,
    thresholds,
)
from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.damping import Release
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper_model import SpringDamperModel
from bouncing_ball.periodic.orbits.orbit import Orbit

SIMPLE = ("restitution", "corrected")
"""The simple models, which are compared with the exact model."""


def exact_and_simple_models(
    contact: SpringDamper,
) -> tuple[SpringDamperModel, RestitutionModel, CorrectedModel]:
    """The exact model of a contact, and both simple models with the r of a free impact on it.

    Raises
    ------
    ModelError
        If ζ ≥ 1.

    Examples
    --------
    >>> [model.name for model in exact_and_simple_models(SpringDamper(5.0, 0.0))]
    ['spring-damper', 'restitution', 'corrected']
    """
    return (
        SpringDamperModel(contact),
        RestitutionModel(contact.restitution),
        CorrectedModel.of_contact(contact),
    )


def errors(
    contact: SpringDamper,
    n: ArrayLike,
    amplitude: ArrayLike,
    quantities: Sequence[str] = OF_IMPACTS,
) -> np.ndarray:
    """Signed relative errors of both simple models on contacts, shape (model, quantity, ...).

    The arguments are those of :func:`relative_errors`, and the models those of
    :func:`exact_and_simple_models`, in the order of :data:`SIMPLE`.

    Examples
    --------
    >>> errors(SpringDamper(100.0, 0.1), 1, 1.0, ["max_height"]).round(4).tolist()
    [[-0.0083], [-0.0]]
    """
    exact, *simple = exact_and_simple_models(contact)
    return relative_errors(exact, simple, n, amplitude, quantities)


def orbit_errors(orbit: Orbit) -> np.ndarray:
    """Errors of the four quantities of exact orbits, shape (model, quantity, ...); NaN where there
    is no orbit.

    They equal :func:`errors` at the Λ of the orbits.

    Examples
    --------
    >>> from bouncing_ball.models.spring_damper import SpringDamper
    >>> from bouncing_ball.periodic.one_impact.spring_damper_bifurcations import orbit_at
    >>> orbit_errors(orbit_at(SpringDamper(100.0, 0.1), 1, 1.0)).round(4)[:, 0].tolist()
    [-0.0083, -0.0]
    """
    exact = [getattr(orbit, quantity) for quantity in OF_ORBITS]
    simple = (
        values(x, orbit.n, orbit.amplitude, OF_ORBITS)
        for x in exact_and_simple_models(orbit.law)[1:]
    )
    return np.stack([[*map(relative, exact, each)] for each in simple])


class Search(NamedTuple):
    """The ϖ above which each simple model is accurate, for several orbits."""

    threshold: np.ndarray
    """ϖ, shape (model, quantity, orbit); NaN where the status is not ``FOUND``."""
    status: np.ndarray
    """:class:`ThresholdStatus`, shape (model, quantity, orbit)."""
    zero: np.ndarray
    """The largest ϖ at which the error of the restitution model changes its sign, shape
    (quantity, orbit); NaN where it does not change its sign."""


def search(
    zeta: ArrayLike,
    rule: Release,
    n: ArrayLike,
    amplitude: ArrayLike,
    ratios: np.ndarray,
    tolerance: float,
    quantities: Sequence[str] = OF_IMPACTS,
    measure: Callable[[np.ndarray], np.ndarray] = np.asarray,
) -> Search:
    """Thresholds and zeros of the errors of both simple models, for linear contacts.

    Parameters
    ----------
    zeta, n, amplitude : array_like
        ζ, index of the family and Λ of each orbit; they broadcast to shape (orbit,).
    rule : Release
    ratios : ndarray, shape (N,)
        Increasing grid of ϖ.
    tolerance : float
        The tolerated relative error.
    quantities : sequence of str
    measure : callable
        The error that is tolerated, as a function of the paper's error (Eqs. 37-38); by default
        the paper's.

    Returns
    -------
    Search
        The restitution model has the r of a free impact on the contact.

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ²:

    >>> grid, rule = np.geomspace(1.0, 1e3, 31), Release.DISPLACEMENT
    >>> found = search(0.0, rule, 1, 1.0, grid, 0.01, ["permanent_contact"])
    >>> found.threshold[0].round(9).tolist()
    [[10.0]]
    """
    damping, index, lam = (np.atleast_1d(x) for x in np.broadcast_arrays(zeta, n, amplitude))
    size = len(quantities), len(SIMPLE), lam.size

    def at(ratio: np.ndarray, orbit: np.ndarray, wanted: Sequence[str]) -> np.ndarray:
        """The errors of the orbits with these indices, shape (model, quantity, m)."""
        contact = SpringDamper(ratio, damping[orbit], rule)
        return measure(errors(contact, index[orbit], lam[orbit], wanted))

    def along(ratio: np.ndarray, row: np.ndarray, wanted: Sequence[str]) -> np.ndarray:
        """The errors of rows of (model, orbit), shape (quantity, m)."""
        model, orbit = np.divmod(row, lam.size)
        return at(ratio, orbit, wanted)[model, :, np.arange(row.size)].T

    orbit, ratio = np.divmod(np.arange(lam.size * ratios.size), ratios.size)
    scanned = at(ratios[ratio], orbit, quantities).swapaxes(0, 1)
    every = scanned.reshape(-1, ratios.size)
    found = thresholds(by_quantity(along, quantities, size[1] * size[2]), ratios, every, tolerance)
    # The restitution model is the first model.
    of_restitution = scanned[:, 0].reshape(-1, ratios.size)
    zero = last_crossing(by_quantity(along, quantities, lam.size), ratios, of_restitution)
    threshold, status = (part.reshape(size).swapaxes(0, 1) for part in found)
    return Search(threshold=threshold, status=status, zero=zero.reshape(-1, lam.size))
