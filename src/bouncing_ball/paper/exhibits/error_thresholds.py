"""How stiff a contact must be for the restitution model to be accurate.

The relative error of a quantity q of the restitution model is
``|q_SD(ϖ) - q_CR| / |q_CR|`` (Eqs. 37-38 for the greatest height and the
permanent contact). The threshold for a tolerance is the ϖ above which the
error stays below it, within the range scanned.
"""

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import xarray as xr
from pydantic import Strict

from bouncing_ball.datasets.parameters import Many, Tolerance
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.paper.comparison.errors import Quantity, modulus, relative_errors
from bouncing_ball.paper.comparison.thresholds import by_quantity, thresholds
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.orbit_parameters import OrbitErrors, OrbitsAlongRatio
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
from bouncing_ball.paper.orbits.spring_damper_model import SpringDamperModel

VARIABLES = {
    "restitution_max_height": Variable(
        "greatest height, restitution model", symbol="max z_CR", equation="Eq. 37"
    ),
}


class ErrorsAlongRatio(OrbitsAlongRatio):
    """One orbit along ϖ, and the quantities compared on it."""

    quantities: Many[Annotated[Quantity, Strict(False)]]


class ErrorThresholds(ErrorsAlongRatio):
    """One orbit, the quantities compared on it and the tolerated relative errors."""

    tolerances: Many[Tolerance]


def error_thresholds(parameters: ErrorThresholds, release: Release) -> xr.Dataset:
    """Errors of the restitution model along ϖ, and the ϖ above which each is tolerable.

    The dataset has ``relative_error`` (quantity, ϖ), the modulus, infinite where a model lacks the
    quantity; ``error_threshold`` (quantity, tolerance), a ϖ, NaN where there is none; and
    ``threshold_status`` (quantity, tolerance), a text.
    """
    asked = parameters.quantities, parameters.tolerances
    return describe(thresholds_along(parameters, release, *asked), variables=VARIABLES)


def height_error(parameters: OrbitErrors, release: Release) -> xr.Dataset:
    """Greatest height along ϖ in both models, and ϖ_h for the tolerance (Eq. 37, Fig. 14).

    The dataset has the variables of :func:`error_thresholds` for the one quantity, and
    ``max_height``, ``phase`` in rad, ``contact_duration``, ``impact_velocity`` and ``admissible``
    of the exact orbit, shape (ϖ,), NaN where there is none; ``restitution_max_height`` is a number.
    """
    n, lam, ratios = parameters.n, parameters.amplitude, parameters.frequency_ratio.grid()
    dataset = thresholds_along(parameters, release, [Quantity.MAX_HEIGHT], [parameters.tolerance])
    contact = SpringDamper.from_restitution(parameters.restitution, ratios, release)
    orbit = SpringDamperModel(contact).orbit(n, lam)
    for name in ("max_height", "phase", "contact_duration", "impact_velocity"):
        dataset[name] = ("frequency_ratio", getattr(orbit, name))
    dataset["admissible"] = ("frequency_ratio", orbit.is_admissible())
    rigid = RestitutionModel(parameters.restitution).orbit(n, lam)
    dataset["restitution_max_height"] = rigid.max_height
    return describe(dataset, variables=VARIABLES)


def thresholds_along(
    one: OrbitsAlongRatio,
    release: Release,
    quantities: Sequence[Quantity],
    tolerances: Sequence[float],
    restitution: float | None = None,
) -> xr.Dataset:
    """Errors of the restitution model along ϖ, and the thresholds of tolerances.

    Parameters
    ----------
    one : OrbitsAlongRatio
    release : Release
    quantities : sequence of Quantity
    tolerances : sequence of float
    restitution : float, optional
        r of the restitution model; by default the r of Eq. 16.

    Returns
    -------
    Dataset
        ``relative_error`` (quantity, ϖ), moduli, infinite where a model lacks the quantity;
        ``error_threshold`` in ϖ and ``threshold_status``, both (quantity, tolerance).
    """
    simple, ratios = RestitutionModel(restitution or one.restitution), one.frequency_ratio.grid()

    def along(ratio: np.ndarray, _: Any, asked: Sequence[str]) -> np.ndarray:
        exact = SpringDamperModel(SpringDamper.from_restitution(one.restitution, ratio, release))
        return relative_errors(exact, [simple], one.n, one.amplitude, asked)[0]

    scanned = along(ratios, None, quantities)
    found = thresholds(by_quantity(along, quantities, 1), ratios, scanned, tolerances)
    dims = ("quantity", "tolerance")
    return xr.Dataset(
        {
            "relative_error": (("quantity", "frequency_ratio"), modulus(scanned)),
            "error_threshold": (dims, found.ratio),
            "threshold_status": (dims, found.status),
        },
        coords={
            "quantity": [str(q) for q in quantities],
            "frequency_ratio": ratios,
            "tolerance": list(tolerances),
        },
    )
