r"""How stiff a contact must be for the restitution model to be right.

The relative error of a quantity q of the restitution model is
``|q_SD(ϖ) - q_CR| / |q_CR|`` (Eqs. 37-38 for the greatest height and the
permanent contact). The threshold for a tolerance is the ϖ above which the
error stays below it, within the range scanned.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.accuracy.thresholds import model_thresholds
from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import describe, described
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.studies.parameters import grid
from bouncing_ball.studies.permanent_contact_curve import PermanentContact, permanent_contact


def error_thresholds(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """Errors along ϖ and thresholds, for every quantity and tolerance.

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit at Λ to compare with.
    """
    n, r, lam = parameters["n"], parameters["restitution"], parameters["amplitude"]
    ratios, simple = grid(parameters["frequency_ratio"]), RestitutionModel(r)
    tolerances = np.array(parameters["tolerances"], dtype=float)
    quantities = [Quantity(name) for name in parameters["quantities"]]

    def exact(ratio: np.ndarray) -> SpringDamperModel:
        return SpringDamperModel(SpringDamper.from_restitution(r, ratio, release))

    error, found = model_thresholds(exact, simple, n, lam, ratios, tolerances, quantities)
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
    still = PermanentContact(
        restitution=parameters["restitution"], frequency_ratio=parameters["frequency_ratio"]
    )
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
    return describe(dataset.merge(permanent_contact(still, Release(release))))
