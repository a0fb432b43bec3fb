"""Stable n-T orbits of the spring-damper model along ϖ (Figs. 5, 6, 10, 13)."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets.variables import describe
from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.spring_damper import Contact, Release
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.contact_orbit import ContactOrbit
from bouncing_ball.orbits.interface import Orbit
from bouncing_ball.orbits.limits import orbit_at
from bouncing_ball.studies.parameters import grid


def sweep(
    n: int, restitution: np.ndarray, amplitude: np.ndarray, ratios: np.ndarray, release: str
) -> ContactOrbit:
    """Orbits on the stable side, shape (cases, ϖ); NaN where there is none."""
    zeta = damping_ratio(restitution)[:, np.newaxis]
    return orbit_at(Contact(ratios, zeta, Release(release)), n, amplitude[:, np.newaxis])


_OBSERVABLES = (
    "phase",
    "contact_duration",
    "release_phase",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
    "max_height",
)


def _columns(orbit: Orbit) -> dict[str, np.ndarray]:
    """What is published of the orbits of one case."""
    return {
        **{name: getattr(orbit, name) for name in _OBSERVABLES},
        "stable": orbit.is_stable(),
        "admissible": orbit.is_admissible(),
    }


def _sweep_dataset(parameters, restitution, amplitude, release) -> xr.Dataset:
    n, ratios = parameters["n"], grid(parameters["frequency_ratio"])
    # Case by case: the scans of all at once are gigabytes for 20 001 samples.
    cases = [
        _columns(sweep(n, restitution[[k]], amplitude[[k]], ratios, release)[0])
        for k in range(len(restitution))
    ]
    dims = ("case", "frequency_ratio")
    return xr.Dataset(
        {
            "restitution": ("case", restitution),
            "amplitude": ("case", amplitude),
            **{name: (dims, np.array([case[name] for case in cases])) for name in cases[0]},
        },
        coords={"frequency_ratio": ratios, "case": np.arange(len(restitution))},
    )


def apparent_restitution(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """r_a along ϖ for ``cases`` of (r, Λ) (Eq. 17; Figs. 5 and 6)."""
    cases = parameters["cases"]
    restitution = np.array([case["restitution"] for case in cases], dtype=float)
    amplitude = np.array([case["amplitude"] for case in cases], dtype=float)
    return describe(_sweep_dataset(parameters, restitution, amplitude, release))


def frequency_sweep(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """The orbits along ϖ for one r and several Λ, with their restitution
    limits (Figs. 10 and 13)."""
    amplitude = np.array(parameters["amplitude"], dtype=float)
    r = parameters["restitution"]
    restitution = np.full_like(amplitude, r)
    dataset = _sweep_dataset(parameters, restitution, amplitude, release)
    n = parameters["n"]
    dataset["restitution_phase"] = ("case", restitution_orbits.phase(n, r, amplitude))
    dataset["restitution_bounce_velocity"] = ((), n * np.pi)
    dataset["restitution_impact_velocity"] = ((), -n * np.pi)
    return describe(dataset)
