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
from bouncing_ball.orbits.limits import orbit_at
from bouncing_ball.studies.parameters import grid


def sweep(
    n: int, restitution: np.ndarray, amplitude: np.ndarray, ratios: np.ndarray, release: str
) -> ContactOrbit:
    """Orbits on the stable side, shape (cases, ϖ); NaN where there is none."""
    zeta = damping_ratio(restitution)[:, np.newaxis]
    return orbit_at(Contact(ratios, zeta, Release(release)), n, amplitude[:, np.newaxis])


def stability_along(orbit: ContactOrbit) -> np.ndarray:
    """Whether each orbit is stable; false where there is none."""
    return orbit.is_stable()


def _sweep_dataset(parameters, restitution, amplitude, release) -> xr.Dataset:
    n, ratios = parameters["n"], grid(parameters["frequency_ratio"])
    orbit = sweep(n, restitution, amplitude, ratios, release)
    dims = ("case", "frequency_ratio")
    return xr.Dataset(
        {
            "restitution": ("case", restitution),
            "amplitude": ("case", amplitude),
            "phase": (dims, orbit.phase),
            "contact_duration": (dims, orbit.contact_duration),
            "release_phase": (dims, orbit.phase + orbit.contact_duration),
            "impact_velocity": (dims, orbit.impact_velocity),
            "bounce_velocity": (dims, orbit.bounce_velocity),
            "apparent_restitution": (dims, orbit.apparent_restitution),
            "max_height": (dims, orbit.max_height),
            "stable": (dims, stability_along(orbit)),
            "admissible": (dims, orbit.is_admissible()),
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
