"""Stage: above which frequency ratio the restitution model is right (Fig. 14 and thresholds)."""

import numpy as np
import xarray as xr

from bouncing_ball import restitution
from bouncing_ball.continuation import upper_orbits
from bouncing_ball.errors import errors, threshold
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact
from paper_replication.datasets import grid


def fig14(parameters: dict, release: str) -> xr.Dataset:
    """Maximum height in both models, and the ϖ above which its error is tolerable (Eq. 37)."""
    n = parameters["n"]
    r = parameters["restitution"]
    amplitude = parameters["amplitude"]
    ratios = grid(parameters["frequency_ratio"])
    family = Family(n, Contact.of_restitution(ratios, r, release))
    orbits = upper_orbits(n, r, amplitude, ratios, release)[:, 0]
    names = ("max_height", "phase", "contact_duration", "impact_velocity", "stable", "admissible")
    quantities = family.observables(orbits, names)
    error = errors(["max_height"], n, r, amplitude, ratios, release)["max_height"]
    crossing = threshold(ratios, error, parameters["tolerance"])
    return xr.Dataset(
        {
            **{name: ("frequency_ratio", values) for name, values in quantities.items()},
            "restitution_max_height": float(restitution.max_height(n, r, amplitude)),
            "relative_error": ("frequency_ratio", error.values),
            "error_threshold": crossing.ratio,
            "threshold_status": crossing.status,
        },
        {"frequency_ratio": ratios},
    )


def thresholds(parameters: dict, release: str) -> xr.Dataset:
    """Errors of the quantities along ϖ, and the thresholds of each tolerance."""
    ratios = grid(parameters["frequency_ratio"])
    known = errors(
        parameters["quantities"],
        parameters["n"],
        parameters["restitution"],
        parameters["amplitude"],
        ratios,
        release,
    )
    tolerances = parameters["tolerances"]
    crossings = [threshold(ratios, error, tolerances) for error in known.values()]
    shape = ("quantity", "tolerance")
    return xr.Dataset(
        {
            "relative_error": (
                ("quantity", "frequency_ratio"),
                [error.values for error in known.values()],
            ),
            "admissible": (
                ("quantity", "frequency_ratio"),
                [np.broadcast_to(error.admissible, ratios.shape) for error in known.values()],
            ),
            "error_threshold": (shape, [crossing.ratio for crossing in crossings]),
            "threshold_status": (shape, [crossing.status for crossing in crossings]),
        },
        {"quantity": list(known), "frequency_ratio": ratios, "tolerance": tolerances},
    )


STAGE = {"fig14": fig14, "thresholds": thresholds}
