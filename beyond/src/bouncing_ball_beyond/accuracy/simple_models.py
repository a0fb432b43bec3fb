"""Errors of the restitution model and of the corrected model on linear contacts, and the
thresholds above which each of them is accurate.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS, relative_errors
from bouncing_ball_beyond.accuracy.thresholds import by_quantity, last_zero
from bouncing_ball_beyond.inherited.accuracy.thresholds import Numbered, thresholds
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

SIMPLE = ("restitution", "corrected")
"""The simple models, which are compared with the exact model."""


def models_of_law(
    law: ContactLaw, restitution: float | np.ndarray
) -> tuple[ContactModel, RestitutionModel, CorrectedModel]:
    """The exact model of a contact law, and both simple models: r of the restitution model is
    given, because that of a free impact may depend on its speed.
    """
    return ContactModel(law), RestitutionModel(restitution), CorrectedModel.of_contact(law)


def exact_and_simple_models(
    contact: SpringDamper,
) -> tuple[ContactModel, RestitutionModel, CorrectedModel]:
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
    return models_of_law(contact, contact.restitution)


def errors(
    contact: SpringDamper,
    n: ArrayLike,
    amplitude: ArrayLike,
    quantities: Sequence[str] = OF_IMPACTS,
) -> np.ndarray:
    """The paper's errors of both simple models on contacts, shape (model, quantity, ...).

    The arguments are those of :func:`.errors.relative_errors`, and the models those of
    :func:`exact_and_simple_models`, in the order of :data:`SIMPLE`.

    Examples
    --------
    >>> errors(SpringDamper(100.0, 0.1), 1, 1.0, ["max_height"]).round(8).tolist()
    [[-0.00829759], [-1.78e-06]]
    """
    exact, *simple = exact_and_simple_models(contact)
    return relative_errors(exact, simple, n, amplitude, quantities)


def simple_models(contact: SpringDamper) -> tuple[RestitutionModel, CorrectedModel]:
    """Both simple models with the r of a free impact on a contact, in the order of SIMPLE."""
    return exact_and_simple_models(contact)[1:]


@dataclass(frozen=True, eq=False)
class Search:
    """Errors of simple models along ϖ, for several orbits, and the ϖ above which they are accurate.

    Parameters
    ----------
    ratios : ndarray, shape (N,)
        The grid of ϖ.
    error : ndarray, shape (model, quantity, orbit, N)
        Signed errors on the grid.
    function : callable
        The same errors at any ϖ, numbered by quantity, model and orbit.
    threshold : ndarray, shape (model, quantity, orbit), and an axis of several tolerances
        ϖ; NaN where the status is not ``FOUND``.
    status : ndarray
        :class:`ThresholdStatus`, of the shape of the thresholds.
    """

    ratios: np.ndarray
    error: np.ndarray
    function: Numbered
    threshold: np.ndarray
    status: np.ndarray

    @cached_property
    def zero(self) -> np.ndarray:
        """The largest ϖ at which each error passes through zero, shape (model, quantity, orbit);
        NaN where it does not.
        """
        scanned = self.error.swapaxes(0, 1)
        found = last_zero(self.function, self.ratios, scanned.reshape(-1, self.ratios.size))
        return found.reshape(scanned.shape[:-1]).swapaxes(0, 1)


def search(
    zeta: ArrayLike,
    rule: Release,
    n: ArrayLike,
    amplitude: ArrayLike,
    ratios: np.ndarray,
    tolerance: ArrayLike,
    quantities: Sequence[str] = OF_IMPACTS,
    measure: Callable[[np.ndarray], np.ndarray] = np.asarray,
    simple: Callable[[SpringDamper], Sequence[Model]] = simple_models,
) -> Search:
    """Thresholds and zeros of the errors of simple models, for linear contacts.

    The thresholds of the paper are ϖ_h,1% and ϖ_PC,1%, the ϖ at which the errors of the greatest
    height (Eq. 37) and of Λ_CR (Eq. 38) are 0.01.

    Parameters
    ----------
    zeta, n, amplitude : array_like
        ζ, index of the family and Λ of each orbit; they broadcast to shape (orbit,).
    rule : Release
    ratios : ndarray, shape (N,)
        Increasing grid of ϖ.
    tolerance : float or array_like, shape (tolerance,)
        The tolerated moduli of the error that ``measure`` gives.
    quantities : sequence of str
    measure : callable
        The error that is tolerated, as a function of the paper's error (Eqs. 37-38): by default
        the paper's, and with :func:`.errors.as_deviation` the deviation from the contact.
    simple : callable
        The simple models of contacts; by default those of :func:`simple_models`.

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ² (Eq. 38):

    >>> grid, rule = np.geomspace(1.0, 1e3, 31), Release.DISPLACEMENT
    >>> found = search(0.0, rule, 1, 1.0, grid, 0.01, ["permanent_contact"])
    >>> found.threshold[0].round(9).tolist()
    [[10.0]]
    """
    damping, index, lam = (np.atleast_1d(x) for x in np.broadcast_arrays(zeta, n, amplitude))

    def at(ratio: np.ndarray, orbit: np.ndarray, wanted: Sequence[str]) -> np.ndarray:
        """The errors of the orbits with these indices, shape (model, quantity, m)."""
        contact = SpringDamper(ratio, damping[orbit], rule)
        exact = ContactModel(contact)
        return measure(relative_errors(exact, simple(contact), index[orbit], lam[orbit], wanted))

    def along(ratio: np.ndarray, row: np.ndarray, wanted: Sequence[str]) -> np.ndarray:
        """The errors of rows of (model, orbit), shape (quantity, m)."""
        model, orbit = np.divmod(row, lam.size)
        return at(ratio, orbit, wanted)[model, :, np.arange(row.size)].T

    # All orbits at all ϖ, one orbit after another.
    orbit, place = np.divmod(np.arange(lam.size * ratios.size), ratios.size)
    scanned = at(ratios[place], orbit, quantities)
    error = scanned.reshape(*scanned.shape[:2], lam.size, ratios.size)
    function = by_quantity(along, quantities, len(error) * lam.size)
    every = error.swapaxes(0, 1).reshape(-1, ratios.size)
    found = thresholds(function, ratios, every, tolerance)
    shape = len(quantities), len(error), lam.size, *np.shape(tolerance)
    threshold, status = (part.reshape(shape).swapaxes(0, 1) for part in found)
    return Search(ratios, error, function, threshold, status)
