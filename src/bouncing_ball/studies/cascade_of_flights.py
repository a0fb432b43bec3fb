"""The cascade of flights of the T-periodic orbits into which permanent contact continues."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.attractors.cascade_of_flights import openings, stiff_openings
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.parameters import LossyRestitution, Many, Parameters, Span, number


class Flights(Parameters):
    """Contacts of several r on a grid of ϖ, and the number of openings that are followed."""

    restitution: Many[LossyRestitution]
    frequency_ratio: Span
    flights: Annotated[int, number("openings that are followed", ge=2, le=6)]


def cascade_of_flights(parameters: Flights, release: Release) -> xr.Dataset:
    """The amplitudes above which the T-periodic orbit above Λ_SD has one more flight per period.

    The dataset has ``threshold_amplitude`` Λ_SD (restitution, ϖ). ``opening_amplitude``
    (restitution, flights, ϖ) is the Λ up to which the orbit has this number of flights, and
    ``opening_multiplier`` the larger modulus of its multipliers there; both are NaN where no stable
    orbit was found. ``stiff_opening`` (restitution, flights) is the limit of E = ϖ²(Λ - Λ_SD) for
    stiff contacts. All except the first are NaN unless the release is the displacement release.
    """
    restitution, ratio = np.array(parameters.restitution), parameters.frequency_ratio.grid()
    zeta, most = damping_ratio(restitution), parameters.flights
    law = SpringDamper(ratio, zeta[:, np.newaxis], release)
    found = np.full((2, zeta.size, most, ratio.size), np.nan)
    stiff = np.full((zeta.size, most), np.nan)
    if release is Release.DISPLACEMENT:
        found = np.array(openings(zeta, ratio, most))
        found = np.where(found[1] < 1, found, np.nan)
        stiff = np.stack([stiff_openings(z, most) for z in zeta])
    dims = ("restitution", "flights", "frequency_ratio")
    held = SpringDamperModel(law).permanent_contact_threshold()
    return described(
        {
            "threshold_amplitude": (("restitution", "frequency_ratio"), held),
            "opening_amplitude": (dims, found[0]),
            "opening_multiplier": (dims, found[1]),
            "stiff_opening": (dims[:2], stiff),
        },
        coords={
            "restitution": restitution,
            "flights": np.arange(1, most + 1),
            "frequency_ratio": ratio,
        },
    )
