"""Ranges of the amplitude in which the n-T orbits are stable (Table 1)."""

import numpy as np
import xarray as xr

from bouncing_ball.contacts.release import Release
from bouncing_ball.continuation.branch import ContinuationError
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.parameters import Family, FrequencyRatio, LossyRestitution, Many, Parameters
from bouncing_ball.studies.columns import PLACE
from bouncing_ball.studies.continuation import (
    PERIOD_DOUBLING,
    SADDLE_NODE,
    Continuation,
    branch_along_amplitude,
    first_limits,
    missing,
)
from bouncing_ball.studies.parameters import RangeEnd
from bouncing_ball.studies.printed_table1 import printed_table


class Ranges(Parameters):
    """Several families on several contacts, whose stable ranges are looked for along Λ."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Many[FrequencyRatio]
    amplitude_max: RangeEnd


def _limits(
    n: int, ratio: float, parameters: Ranges, release: Release, continuation: Continuation
) -> tuple[Orbit, str]:
    """The orbits at both ends of the stable range, or NaN and why there is none."""
    r, top = parameters.restitution, parameters.amplitude_max
    try:
        system, branch = branch_along_amplitude(n, r, ratio, top, release, continuation)
        return system.orbit(first_limits(branch)), ""
    except (NoOrbitError, ContinuationError) as error:
        return missing(n, 2), str(error)


def stability_ranges(
    parameters: Ranges,
    release: Release,
    continuation: Continuation,
) -> xr.Dataset:
    """Ranges of Λ in which the n-T orbits are stable, computed and printed (Table 1).

    Shape (ϖ, n, bound), the bounds a saddle-node and a period doubling.

    Where an orbit has no such range the entry is NaN, and ``absence`` says why.
    """
    families, ratios, r = parameters.n, parameters.frequency_ratio, parameters.restitution
    found = [
        [_limits(n, ratio, parameters, release, continuation) for n in families] for ratio in ratios
    ]
    rigid = RestitutionModel(r).saddle_node(np.array(families)).amplitude
    maps = list(restitution_orbits.ImpactMap)
    doublings = [restitution_orbits.period_doubling(np.array(families), r, kind) for kind in maps]
    dims = ("frequency_ratio", "n", "bound")
    columns = {
        name: np.array([[getattr(orbit, name) for orbit, _ in row] for row in found])
        for name in PLACE
    }
    reasons = np.array([[reason for _, reason in row] for row in found])
    dataset = xr.Dataset(
        {
            "computed": (dims, columns["amplitude"]),
            "special_phase": (dims, columns["phase"]),
            "special_contact_duration": (dims, columns["contact_duration"]),
            # NaN where the paper has no entry.
            "printed": printed_table().reindex(frequency_ratio=list(ratios), n=list(families)),
            "restitution_range": (
                ("impact_map", "n", "bound"),
                np.array([np.stack([rigid, doubling], axis=-1) for doubling in doublings]),
            ),
        },
        coords={
            "frequency_ratio": np.array(ratios),
            "n": np.array(families),
            "bound": [SADDLE_NODE, PERIOD_DOUBLING],
            "impact_map": [str(kind) for kind in maps],
        },
    )
    if np.any(reasons != ""):
        dataset["absence"] = (dims[:2], reasons)
    return describe(dataset)
