"""Permanent-contact threshold along ϖ (Fig. 11)."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.permanent_contact import (
    RESTITUTION_THRESHOLD,
    permanent_contact_minimum,
    permanent_contact_threshold,
)
from bouncing_ball.contacts.spring_damper import Release
from bouncing_ball.datasets.variables import described
from bouncing_ball.studies.parameters import grid


def permanent_contact(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """The threshold along ϖ with its minimum and the restitution model's Λ_CR.

    Raises
    ------
    ModelError
        If the damping is too strong for a minimum to exist.
    """
    ratios = grid(parameters["frequency_ratio"])
    zeta = float(damping_ratio(parameters["restitution"]))
    lowest = permanent_contact_minimum(zeta, Release(release))
    return described(
        {
            "threshold_amplitude": (
                "frequency_ratio",
                permanent_contact_threshold(ratios, zeta, Release(release)),
            ),
            "minimum_threshold": ((), float(lowest.threshold)),
            "minimum_frequency_ratio": ((), float(lowest.frequency_ratio)),
            "restitution_threshold": ((), RESTITUTION_THRESHOLD),
            "damping_ratio": ((), zeta),
        },
        coords={"frequency_ratio": ratios},
    )
