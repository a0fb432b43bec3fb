"""Stage: stable n-T orbits of the spring-damper model along the frequency ratio (Figs. 5, 6, 10 and
13).
"""

import numpy as np
import xarray as xr

from bouncing_ball import restitution
from bouncing_ball.continuation import upper_orbits
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact
from paper_replication.datasets import grid

QUANTITIES = (
    "phase",
    "contact_duration",
    "release_phase",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
    "max_height",
    "stable",
    "admissible",
)
"""Quantities of every orbit."""


def along_frequency_ratio(
    n: int,
    r: np.ndarray,
    amplitude: np.ndarray,
    ratios: np.ndarray,
    release: str,
) -> xr.Dataset:
    """The quantities of the orbits, shape (case, ϖ), NaN where there is none."""
    family = Family(n, Contact.of_restitution(ratios, r[:, np.newaxis], release))
    quantities = family.observables(upper_orbits(n, r, amplitude, ratios, release), QUANTITIES)
    shape = ("case", "frequency_ratio")
    labels = [f"r = {one:g}, Λ = {other:g}" for one, other in zip(r, amplitude, strict=True)]
    return xr.Dataset(
        {name: (shape, values) for name, values in quantities.items()},
        {
            "case": labels,
            "frequency_ratio": ratios,
            "restitution": ("case", r),
            "amplitude": ("case", amplitude),
        },
    )


def cases(parameters: dict, release: str) -> xr.Dataset:
    """Pairs of r and Λ (Figs. 5 and 6)."""
    r = np.array([case["restitution"] for case in parameters["cases"]])
    amplitude = np.array([case["amplitude"] for case in parameters["cases"]])
    ratios = grid(parameters["frequency_ratio"])
    return along_frequency_ratio(parameters["n"], r, amplitude, ratios, release)


def amplitudes(parameters: dict, release: str) -> xr.Dataset:
    """One r and several Λ (Figs. 10 and 13), with the limits of a stiff contact: phase and
    velocities of the restitution model.
    """
    n = parameters["n"]
    ratios = grid(parameters["frequency_ratio"])
    amplitude = np.array(parameters["amplitude"])
    r = np.full(amplitude.shape, parameters["restitution"])
    velocity = float(restitution.bounce_velocity(n))
    phase = restitution.impact_phase(n, r, amplitude)
    impact_height = amplitude * np.sin(phase)
    return along_frequency_ratio(n, r, amplitude, ratios, release).assign(
        restitution_phase=("case", phase),
        restitution_bounce_velocity=velocity,
        restitution_stable=("case", restitution.stable(r, impact_height)),
        restitution_admissible=(
            "case",
            restitution.admissible(n, parameters["restitution"], impact_height),
        ),
        restitution_impact_velocity=-velocity,
    )


STAGE = {"fig05": cases, "fig06": cases, "fig10": amplitudes, "fig13": amplitudes}
