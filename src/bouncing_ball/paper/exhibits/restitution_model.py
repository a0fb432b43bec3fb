"""Orbits of the restitution model: time history and domains (Figs. 2 and 3)."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import Samples, number
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.paper.exhibits.orbit_parameters import FamilyBranches, OrbitParameters
from bouncing_ball.periodic.explicit import required_orbit
from bouncing_ball.periodic.orbit import path
from bouncing_ball.periodic.restitution_branch import (
    ImpactMap,
    RestitutionBranch,
    period_doubling_lift,
    restitution_period_doubling,
    restitution_saddle_node,
)

VARIABLES = {
    "grazing_amplitude": Variable(
        "amplitude at which the unstable orbit grazes the table", symbol="Λ"
    ),
    "grazing_phase": Variable(
        "phase at which the unstable orbit grazes the table", symbol="φ", units="rad"
    ),
}


class RestitutionHistory(OrbitParameters):
    """One orbit of the restitution model over time."""

    periods: Annotated[int, number("periods of the orbit shown", ge=1, le=20)]
    samples: Samples


def restitution_orbits(parameters: FamilyBranches) -> xr.Dataset:
    """φ against Λ for several families of the restitution model (Fig. 3).

    The dataset has ``amplitude``, ``phase`` in rad, ``stable`` and ``admissible`` (n, point), from
    the unstable to the stable side up to Λ = ``amplitude_max``; Λ and φ of the saddle-node and of
    the grazing orbit (n,); and those of the period doubling for both maps (impact_map, n).

    Raises
    ------
    NoOrbitError
        If a family does not exist up to ``amplitude_max``.
    """
    n = np.array(parameters.n)
    r = parameters.restitution
    top = parameters.amplitude_max
    branch = RestitutionBranch(RestitutionModel(r))
    shown = branch.along(n, top, parameters.points)
    grazing = [branch.grazing(family, top) for family in parameters.n]
    fold = restitution_saddle_node(n, r)
    maps = list(ImpactMap)
    doubling = [restitution_period_doubling(n, r, kind) for kind in maps]
    lift = np.array([[float(period_doubling_lift(r, kind))] for kind in maps])
    return described(
        {
            "amplitude": (("n", "point"), shown.amplitude),
            "phase": (("n", "point"), shown.phase),
            "stable": (("n", "point"), shown.stable),
            "admissible": (("n", "point"), shown.admissible),
            "grazing_amplitude": ("n", [float(each.amplitude) for each in grazing]),
            "grazing_phase": ("n", [float(each.phase) for each in grazing]),
            "saddle_node_amplitude": ("n", fold),
            "saddle_node_phase": ("n", np.zeros_like(fold)),
            "period_doubling_amplitude": (("impact_map", "n"), doubling),
            "period_doubling_phase": (("impact_map", "n"), np.arctan2(lift, fold)),
        },
        coords={"n": n, "impact_map": [str(kind) for kind in maps]},
        variables=VARIABLES,
    )


def restitution_history(parameters: RestitutionHistory) -> xr.Dataset:
    """Ball and table over some periods of an orbit of the restitution model (Fig. 2).

    The dataset has ``ball``, ``ball_velocity`` and ``table`` (time,), and the number ``phase`` in
    rad.

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node.
    """
    n = parameters.n
    lam = parameters.amplitude
    orbit = required_orbit(RestitutionModel(parameters.restitution), n, lam)
    time = np.linspace(0.0, parameters.periods * 2 * np.pi * n, parameters.samples)
    height, velocity = path(orbit, time)
    return described(
        {
            "ball": ("time", height),
            "ball_velocity": ("time", velocity),
            "table": ("time", lam * np.sin(time + orbit.phase)),
            "phase": ((), float(orbit.phase)),
        },
        coords={"time": time},
        variables=VARIABLES,
    )
