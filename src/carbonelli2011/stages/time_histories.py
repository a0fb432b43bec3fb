"""Stage: heights of ball and table over a cycle (Figs. 7 and 12), and around one contact."""

import numpy as np
import xarray as xr

from bouncing_ball import restitution
from bouncing_ball.continuation import upper_orbits
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact

# Quantities of each orbit in the datasets.
STATE = (
    "phase",
    "contact_duration",
    "impact_velocity",
    "bounce_velocity",
    "stable",
    "admissible",
)
INSTANT = (
    "phase",
    "contact_duration",
    "centroid",
    "centroid_gap",
    "summit",
    "stable",
    "admissible",
)
"""Quantities of a contact that the dataset of its equivalent impact needs."""


def fig07(parameters: dict, release: str) -> xr.Dataset:
    """One cycle from the start of the contact.

    Half of the samples are in the contact, because it may last a hundredth of the cycle.
    """
    n = parameters["n"]
    r = parameters["restitution"]
    amplitude = parameters["amplitude"]
    ratio = parameters["frequency_ratio"]
    family = Family(n, Contact.of_restitution(ratio, r, release))
    y = upper_orbits(n, r, amplitude, ratio, release)[:, 0, 0]
    orbit = family.observables(y, STATE)
    half = parameters["samples"] // 2
    during = np.linspace(0, orbit["contact_duration"], half)
    # The last sample of the contact is its end, and that of the flight the next start.
    after = np.linspace(orbit["contact_duration"], family.period, parameters["samples"] - half + 1)
    time = np.concatenate([during, after[1:]])
    height, velocity, _ = family.motion(y, time)
    return xr.Dataset(
        {
            "ball": ("time", height),
            "ball_velocity": ("time", velocity),
            "table": ("time", amplitude * np.sin(time + orbit["phase"])),
            "contact": ("time", np.arange(time.size) < half),
            "frequency_ratio": ratio,
            **{name: orbit[name] for name in STATE},
        },
        {"time": time},
    )


def fig12(parameters: dict, release: str) -> xr.Dataset:
    """One cycle of both models against the phase of the table.

    The samples are at equal steps of the phase and at the starts and ends of all contacts, at which
    the curves have corners.
    """
    n = parameters["n"]
    r = parameters["restitution"]
    amplitude = parameters["amplitude"]
    ratios = np.sort(parameters["frequency_ratio"])
    period = 2 * np.pi * n
    families = [Family(n, Contact.of_restitution(ratio, r, release)) for ratio in ratios]
    orbits = upper_orbits(n, r, amplitude, ratios, release)[:, 0]
    rows = [family.observables(y, STATE) for family, y in zip(families, orbits.T, strict=True)]
    state = {name: np.array([row[name] for row in rows]) for name in STATE}
    phase = float(restitution.impact_phase(n, r, amplitude))
    corners = np.concatenate([[phase], state["phase"], state["phase"] + state["contact_duration"]])
    corners = corners[np.isfinite(corners)] % period
    table_phase = np.union1d(np.linspace(0, period, parameters["samples"]), corners)
    balls = []
    contacts = []
    for family, y in zip(families, orbits.T, strict=True):
        # By rounding, the start of a contact could be at the end of the cycle, and its end outside.
        since = np.mod(table_phase - y[1] + 1e-13, period)
        height, _, _ = family.motion(y, np.maximum(since - 1e-13, 0))
        balls.append(height)
        contacts.append(since <= y[3] / family.contact.frequency_ratio + 2e-13)
    impact_height = amplitude * np.sin(phase)
    shape = ("frequency_ratio", "table_phase")
    return xr.Dataset(
        {
            "ball": (shape, balls),
            "contact": (shape, contacts),
            "restitution_ball": (
                "table_phase",
                restitution.height(n, impact_height, table_phase - phase),
            ),
            "table": ("table_phase", amplitude * np.sin(table_phase)),
            "restitution_phase": phase,
            "restitution_stable": restitution.stable(r, impact_height),
            "restitution_admissible": restitution.admissible(n, r, impact_height),
            **{name: ("frequency_ratio", values) for name, values in state.items()},
        },
        {"frequency_ratio": ratios, "table_phase": table_phase},
    )


def impact_instant(parameters: dict, release: str) -> xr.Dataset:
    """A contact in each case, and the impact at an instant that is equivalent outside of it.

    Times are counted from the impact of the restitution model, and half of the samples are in the
    contact. The equivalent impact is at the centroid of the contact force (`Family.centroid`).

    If the ball rises after the contact, its summit differs from that of the restitution model by
    `depth + table_rise`.
    """
    n = parameters["n"]
    cases = parameters["cases"]
    r, amplitude, ratio = (
        np.array([case[name] for case in cases])
        for name in ("restitution", "amplitude", "frequency_ratio")
    )
    family = Family(n, Contact.of_restitution(ratio, r, release))
    along, position = np.unique(ratio, return_inverse=True)
    y = upper_orbits(n, r, amplitude, along, release)[:, np.arange(ratio.size), position]
    orbit = family.observables(y, INSTANT)
    quarter = max(1, parameters["samples"] // 4)
    part = np.arange(-quarter, 3 * quarter + 1)[:, np.newaxis] / (2 * quarter)
    since = part * orbit["contact_duration"]
    table = amplitude * np.sin(orbit["phase"] + since)
    x, impact_height, u = family.start(y)
    acceleration = family.contact.motion(since, u, x, impact_height).acceleration
    touching = (part >= 0) & (part <= 1)
    table_there = amplitude * np.sin(orbit["phase"] + orbit["centroid"])
    turn = table_there + orbit["centroid_gap"]
    rigid_phase = restitution.impact_phase(n, r, amplitude)
    touch = orbit["phase"] - rigid_phase
    shape = ("sample", "case")
    names = zip(r, amplitude, ratio, strict=True)
    return xr.Dataset(
        {
            "time": (shape, touch + since),
            "ball": (shape, family.motion(y, np.mod(since, family.period))[0]),
            "table": (shape, table),
            "instant_ball": (shape, restitution.height(n, turn, abs(since - orbit["centroid"]))),
            # z″ = w″ + δ″ = -1 + F.
            "force": (shape, np.where(touching, 1 + acceleration - table, 0)),
            "touch": ("case", touch),
            "centroid": ("case", touch + orbit["centroid"]),
            "release": ("case", touch + orbit["contact_duration"]),
            "depth": ("case", orbit["centroid_gap"]),
            "table_rise": ("case", table_there - amplitude * np.sin(rigid_phase)),
            "summit": ("case", orbit["summit"]),
            "restitution_max_height": ("case", restitution.max_height(n, r, amplitude)),
            "stable": ("case", orbit["stable"]),
            "admissible": ("case", orbit["admissible"]),
        },
        {
            "case": [f"r = {one:g}, Λ = {two:g}, ϖ = {three:g}" for one, two, three in names],
            "restitution": ("case", r),
            "amplitude": ("case", amplitude),
            "frequency_ratio": ("case", ratio),
        },
    )


STAGE = {"fig07": fig07, "fig12": fig12, "impact_instant": impact_instant}
