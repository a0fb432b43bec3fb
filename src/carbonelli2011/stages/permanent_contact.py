"""Stage: the threshold of permanent contact along the frequency ratio (Figs. 11 and 16)."""

import numpy as np
import xarray as xr

from bouncing_ball import restitution, spring_damper
from bouncing_ball.errors import permanent_contact_error, threshold
from bouncing_ball.orbits import contact_of_ball
from paper_replication.datasets import grid


def fig11(parameters: dict, release: str) -> xr.Dataset:
    """Λ_SD with its lowest value (Eqs. 33 and 36), and Λ_CR (Eq. 9)."""
    ratios = grid(parameters["frequency_ratio"])
    contact = contact_of_ball(ratios, parameters["restitution"], release)
    zeta = float(contact.damping_ratio)
    lowest_ratio, lowest = spring_damper.lowest_permanent_contact(zeta, release)
    thresholds = spring_damper.permanent_contact(ratios, zeta, release)
    return xr.Dataset(
        {
            "threshold_amplitude": ("frequency_ratio", thresholds),
            "minimum_threshold": lowest,
            "minimum_frequency_ratio": lowest_ratio,
            "restitution_threshold": restitution.PERMANENT_CONTACT,
            "damping_ratio": zeta,
        },
        {"frequency_ratio": ratios},
    )


def fig16(parameters: dict, release: str) -> xr.Dataset:
    """As Fig. 11, with the error of Λ_CR and the ϖ above which it is tolerable (Eq. 38)."""
    ratios = grid(parameters["frequency_ratio"])
    contact = contact_of_ball(ratios, parameters["restitution"], release)
    zeta = float(contact.damping_ratio)
    error = permanent_contact_error(ratios, zeta, release)
    # The error turns at the lowest threshold, and where it is zero: no last crossing is missed.
    lowest_ratio, _ = spring_damper.lowest_permanent_contact(zeta, release)
    turns = np.union1d(ratios, np.clip(lowest_ratio, ratios[0], ratios[-1]))
    searched = permanent_contact_error(turns, zeta, release)
    crossing = threshold(turns, searched, parameters["tolerance"])
    return fig11(parameters, release).assign(
        relative_error=("frequency_ratio", error.values),
        error_threshold=crossing.ratio,
        threshold_status=crossing.status,
    )


STAGE = {"fig11": fig11, "fig16": fig16}
