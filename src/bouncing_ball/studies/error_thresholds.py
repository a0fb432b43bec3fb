r"""How stiff a contact must be for the restitution model to be right.

The relative error of a quantity q of the restitution model is
``|q_SD(ϖ) - q_CR| / |q_CR|`` (Eqs. 37-38 for the greatest height and the
permanent contact). The threshold for a tolerance is the ϖ above which the
error stays below it, within the range scanned.
"""

from collections.abc import Callable, Iterable, Mapping
from enum import StrEnum
from functools import cache
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import describe, described
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import OBSERVABLES
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.studies.last_crossing import last_crossing
from bouncing_ball.studies.parameters import grid
from bouncing_ball.studies.permanent_contact_curve import permanent_contact


class Quantity(StrEnum):
    """What is compared between the models."""

    MAX_HEIGHT = "max_height"
    BOUNCE_VELOCITY = "bounce_velocity"
    PHASE = "phase"
    APPARENT_RESTITUTION = "apparent_restitution"
    SADDLE_NODE = "saddle_node"
    PERIOD_DOUBLING = "period_doubling"
    PERMANENT_CONTACT = "permanent_contact"


class ThresholdStatus(StrEnum):
    """Outcome of the search for a threshold."""

    FOUND = "found"
    ALWAYS_WITHIN = "within the tolerance at every frequency ratio scanned"
    NEVER_WITHIN = "outside the tolerance at the largest frequency ratio scanned"


def value(quantity: str, model: ImpactModel, n: ArrayLike, amplitude: ArrayLike) -> np.ndarray:
    """A quantity in a model; NaN where it does not exist there.

    Examples
    --------
    >>> float(value("bounce_velocity", RestitutionModel(0.5), 1, 2.0)) == np.pi
    True
    """
    return values([quantity], model, n, amplitude)[0]


def values(
    quantities: Iterable[str], model: ImpactModel, n: ArrayLike, amplitude: ArrayLike
) -> list[np.ndarray]:
    """Several quantities in a model, from one search for the orbit."""
    orbit = cache(lambda: model.orbit(n, amplitude))
    special: dict[str, Callable[[], np.ndarray]] = {
        Quantity.PERMANENT_CONTACT: model.permanent_contact_threshold,
        Quantity.SADDLE_NODE: lambda: model.saddle_node(n).amplitude,
        Quantity.PERIOD_DOUBLING: lambda: model.period_doubling(n).amplitude,
    }
    return [special[q]() if q in special else getattr(orbit(), q) for q in quantities]


def relative_error(
    quantity: str, exact: ImpactModel, simple: ImpactModel, n: int, amplitude: float
) -> np.ndarray:
    """|q_SD - q_CR|/|q_CR| of an exact and a simple model (Eqs. 37-38).

    Where the exact model has no such quantity the error is infinite, and so it
    is where the simple model's value is 0, which leaves nothing to be relative
    to (the saddle-node and the phase at r = 1).

    Raises
    ------
    NoOrbitError
        If the simple model has no orbit at Λ to compare with.

    Examples
    --------
    Without damping, Λ_SD = 1 - 1/ϖ² above the resonance:

    >>> stiff = SpringDamperModel(SpringDamper.from_restitution(1.0, np.array([2.0])))
    >>> relative_error(Quantity.PERMANENT_CONTACT, stiff, RestitutionModel(1.0), 1, 1.0).tolist()
    [0.25]
    """
    if quantity in OBSERVABLES:
        simple.require_orbit(n, amplitude)
    reference = float(value(quantity, simple, n, amplitude))
    found = value(quantity, exact, n, amplitude)
    if reference == 0:
        return np.full(np.shape(found), np.inf)
    error = np.abs(found - reference) / abs(reference)
    return np.where(np.isnan(error), np.inf, error)


def excess(error: np.ndarray, tolerance: ArrayLike) -> np.ndarray:
    """ln(error/tolerance), nearly a straight line in ln ϖ.

    Bounded, so that an infinite or vanishing error does not upset a root finder.

    Examples
    --------
    >>> excess(np.array([0.01, 0.0]), 0.01) < np.array([1.0, -600.0])
    array([ True,  True])
    """
    return np.log(np.clip(error, 1e-300, 1e3) / tolerance)


def status(outside: np.ndarray) -> ThresholdStatus:
    """Outcome of the search for a threshold, from where a scanned error exceeds the tolerance.

    Examples
    --------
    >>> status(np.array([True, False])).name
    'FOUND'
    """
    if outside[-1]:
        return ThresholdStatus.NEVER_WITHIN
    return ThresholdStatus.FOUND if outside.any() else ThresholdStatus.ALWAYS_WITHIN


def thresholds(
    error: Callable[[np.ndarray], np.ndarray],
    tolerances: ArrayLike,
    ratios: np.ndarray,
    scanned: np.ndarray | None = None,
) -> tuple[np.ndarray, list[ThresholdStatus]]:
    """The ϖ above which an error stays within each tolerance.

    Parameters
    ----------
    error : callable
        Relative error as a function of an array of ϖ.
    tolerances : ndarray, shape (m,)
    ratios : ndarray
        Increasing grid, scanned for the last crossing of each tolerance; the
        crossing is then closed to the last digit.
    scanned : ndarray, optional
        The errors on the grid, if they are known already.

    Returns
    -------
    ndarray, list of ThresholdStatus
        NaN where the status is not ``FOUND``.

    Examples
    --------
    >>> thresholds(lambda ratio: 1 / ratio, np.array([0.01]), np.geomspace(1, 1e4, 50))[0]
    array([100.])
    """
    tolerances = np.asarray(tolerances, dtype=float)
    scanned = error(ratios) if scanned is None else scanned
    outside = scanned > tolerances[:, np.newaxis]
    result = last_crossing(
        lambda ratio, which: excess(error(ratio), tolerances[which]),
        ratios,
        excess(scanned, tolerances[:, np.newaxis]),
    )
    return np.where(outside[:, -1], np.nan, result), [status(row) for row in outside]


def error_thresholds(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Errors along ϖ and thresholds, for every quantity and tolerance."""
    n, r, lam = parameters["n"], parameters["restitution"], parameters["amplitude"]
    ratios, simple = grid(parameters["frequency_ratio"]), RestitutionModel(r)
    tolerances = np.array(parameters["tolerances"], dtype=float)
    quantities = [Quantity(name) for name in parameters["quantities"]]
    errors, roots, statuses = [], [], []
    for quantity in quantities:

        def error(ratio, quantity=quantity):
            exact = SpringDamperModel(SpringDamper.from_restitution(r, ratio, release))
            return relative_error(quantity, exact, simple, n, lam)

        errors.append(error(ratios))
        found, status = thresholds(error, tolerances, ratios, errors[-1])
        roots.append(found)
        statuses.append([str(s) for s in status])
    dims = ("quantity", "tolerance")
    return described(
        {
            "relative_error": (("quantity", "frequency_ratio"), np.array(errors)),
            "error_threshold": (dims, np.array(roots)),
            "threshold_status": (dims, np.array(statuses)),
        },
        coords={
            "quantity": [str(q) for q in quantities],
            "frequency_ratio": ratios,
            "tolerance": tolerances,
        },
    )


def height_error(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Greatest height along ϖ in both models, and ϖ_h for ``tolerance`` (Fig. 14)."""
    n, r, lam = parameters["n"], parameters["restitution"], parameters["amplitude"]
    dataset = error_thresholds(
        {
            **parameters,
            "quantities": [Quantity.MAX_HEIGHT],
            "tolerances": [parameters["tolerance"]],
        },
        release,
    )
    contact = SpringDamper.from_restitution(r, dataset.frequency_ratio.values, release)
    orbit = SpringDamperModel(contact).orbit(n, lam)
    for name in ("max_height", "phase", "contact_duration", "impact_velocity"):
        dataset[name] = ("frequency_ratio", getattr(orbit, name))
    dataset["admissible"] = ("frequency_ratio", orbit.is_admissible())
    dataset["restitution_max_height"] = RestitutionModel(r).orbit(n, lam).max_height
    return describe(dataset)


def permanent_contact_error(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Permanent contact along ϖ in both models, and ϖ_PC for ``tolerance`` (Fig. 16)."""
    dataset = error_thresholds(
        {
            **parameters,
            # The threshold of permanent contact knows neither orbit nor amplitude.
            "n": 1,
            "amplitude": RESTITUTION_THRESHOLD,
            "quantities": [Quantity.PERMANENT_CONTACT],
            "tolerances": [parameters["tolerance"]],
        },
        release,
    )
    return describe(dataset.merge(permanent_contact(parameters, release)))
