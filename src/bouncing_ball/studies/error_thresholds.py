r"""How stiff a contact must be for the restitution model to be right.

The relative error of a quantity q of the restitution model is
``|q_SD(ϖ) - q_CR| / |q_CR|`` (Eqs. 37-38 for the greatest height and the
permanent contact). The threshold for a tolerance is the ϖ above which the
error stays below it, within the range scanned.
"""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Strict

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.accuracy.thresholds import model_thresholds
from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import describe, described
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.parameters import Many, Span, Tolerance
from bouncing_ball.studies.parameters import OrbitParameters
from bouncing_ball.studies.permanent_contact_curve import PermanentContact, permanent_contact


class ErrorThresholds(OrbitParameters):
    """One orbit, the quantities compared on it and the errors tolerated."""

    quantities: Many[Annotated[Quantity, Strict(False)]]
    tolerances: Many[Tolerance]
    frequency_ratio: Span


class HeightError(OrbitParameters):
    """One orbit, and the error tolerated of its greatest height."""

    frequency_ratio: Span
    tolerance: Tolerance


class PermanentContactError(PermanentContact):
    """The error tolerated of the threshold of permanent contact."""

    tolerance: Tolerance


def error_thresholds(parameters: ErrorThresholds, release: Release) -> xr.Dataset:
    """Errors along ϖ, shape (quantity, ϖ), and thresholds in ϖ, shape (quantity, tolerance).

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit at Λ to compare with.
    """
    orbit = parameters.n, parameters.restitution, parameters.amplitude
    ratios, quantities = parameters.frequency_ratio.grid(), parameters.quantities
    return _thresholds(*orbit, ratios, quantities, parameters.tolerances, release)


def _thresholds(
    n: int,
    r: float,
    lam: float,
    ratios: np.ndarray,
    quantities: Sequence[Quantity],
    tolerances: Sequence[float],
    release: Release,
) -> xr.Dataset:
    def exact(ratio: np.ndarray) -> SpringDamperModel:
        return SpringDamperModel(SpringDamper.from_restitution(r, ratio, release))

    error, found = model_thresholds(
        exact, RestitutionModel(r), n, lam, ratios, tolerances, quantities
    )
    dims = ("quantity", "tolerance")
    return described(
        {
            "relative_error": (("quantity", "frequency_ratio"), error),
            "error_threshold": (dims, found.ratio),
            "threshold_status": (dims, found.status),
        },
        coords={
            "quantity": [str(q) for q in quantities],
            "frequency_ratio": ratios,
            "tolerance": np.array(tolerances),
        },
    )


def height_error(parameters: HeightError, release: Release) -> xr.Dataset:
    """Greatest height along ϖ in both models, and ϖ_h for the tolerance (Eq. 37, Fig. 14).

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit at Λ to compare with.
    """
    n, r, lam = parameters.n, parameters.restitution, parameters.amplitude
    ratios, tolerances = parameters.frequency_ratio.grid(), [parameters.tolerance]
    dataset = _thresholds(n, r, lam, ratios, [Quantity.MAX_HEIGHT], tolerances, release)
    contact = SpringDamper.from_restitution(r, ratios, release)
    orbit = SpringDamperModel(contact).orbit(n, lam)
    for name in ("max_height", "phase", "contact_duration", "impact_velocity"):
        dataset[name] = ("frequency_ratio", getattr(orbit, name))
    dataset["admissible"] = ("frequency_ratio", orbit.is_admissible())
    dataset["restitution_max_height"] = RestitutionModel(r).orbit(n, lam).max_height
    return describe(dataset)


def permanent_contact_error(parameters: PermanentContactError, release: Release) -> xr.Dataset:
    """Permanent contact along ϖ in both models, and ϖ_PC for the tolerance (Eq. 38, Fig. 16)."""
    r, ratios = parameters.restitution, parameters.frequency_ratio.grid()
    # The threshold of permanent contact knows neither orbit nor amplitude.
    nowhere, asked = (1, r, RESTITUTION_THRESHOLD), [Quantity.PERMANENT_CONTACT]
    dataset = _thresholds(*nowhere, ratios, asked, [parameters.tolerance], release)
    return describe(dataset.merge(permanent_contact(parameters, release)))
