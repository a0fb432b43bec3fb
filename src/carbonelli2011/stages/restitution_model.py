"""Stage: the restitution model alone (Figs. 2 and 3, and three balls)."""

import numpy as np
import xarray as xr

from bouncing_ball import restitution

# Impacts of each ball that are stored.
FIRST = 12


def fig02(parameters: dict) -> xr.Dataset:
    """Ball and table over some periods of the n-T orbit that is stable next to the saddle-node."""
    n = parameters["n"]
    r = parameters["restitution"]
    amplitude = parameters["amplitude"]
    phase = restitution.impact_phase(n, r, amplitude)
    impact_height = amplitude * np.sin(phase)
    time = np.linspace(0, parameters["periods"] * 2 * np.pi * n, parameters["samples"])
    return xr.Dataset(
        {
            "ball": ("time", restitution.height(n, impact_height, time)),
            "ball_velocity": ("time", restitution.velocity(n, time)),
            "table": ("time", amplitude * np.sin(time + phase)),
            "phase": float(phase),
            "stable": restitution.stable(r, impact_height),
            "admissible": restitution.admissible(n, r, impact_height),
        },
        {"time": time},
    )


def fig03(parameters: dict) -> xr.Dataset:
    """Phases of n-T orbits against Λ, from the unstable to the stable side, at equal steps of the
    height of the impact; both period doublings, and the grazing orbit if it is within the range
    of Λ.
    """
    n = np.array(parameters["n"])
    r = parameters["restitution"]
    largest = parameters["amplitude_max"]
    x = restitution.saddle_node(n, r)
    highest = np.sqrt(np.where(x <= largest, largest**2 - x**2, np.nan))
    impact_height = np.linspace(-1, 1, parameters["points"]) * highest[:, np.newaxis]
    grazing = np.array([restitution.grazing_height(family, r) for family in n])
    seen = np.hypot(x, grazing) <= largest
    doublings = [restitution.period_doubling(n, r), restitution.holmes_period_doubling(n, r)]
    shape = ("n", "point")
    return xr.Dataset(
        {
            "amplitude": (shape, np.hypot(x[:, np.newaxis], impact_height)),
            "phase": (shape, np.arctan2(impact_height, x[:, np.newaxis])),
            "stable": (shape, restitution.stable(r, impact_height)),
            "admissible": (
                shape,
                [
                    restitution.admissible(family, r, heights)
                    for family, heights in zip(n, impact_height, strict=True)
                ],
            ),
            "grazing_amplitude": ("n", np.where(seen, np.hypot(x, grazing), np.nan)),
            "grazing_phase": ("n", np.where(seen, np.arctan2(grazing, x), np.nan)),
            "saddle_node_amplitude": ("n", x),
            "saddle_node_phase": ("n", np.zeros_like(x)),
            "period_doubling_amplitude": (("impact_map", "n"), doublings),
            "period_doubling_phase": (("impact_map", "n"), np.arccos(x / doublings)),
        },
        {"n": n, "impact_map": ["exact", "holmes"], "point": np.arange(parameters["points"])},
    )


OF_A_BALL = (
    "impacts",
    "periods",
    "stickings",
    "lyapunov_exponent",
    "lyapunov_error",
)


def three_balls(parameters: dict) -> xr.Dataset:
    """After how many impacts the motion of each ball repeats, or how fast its neighbours separate,
    and its first impacts, before rounding errors have grown.

    All balls have the same phase and relative speed at their first impact.
    """
    r = parameters["restitution"]
    amplitudes = np.array(parameters["amplitude"])
    phase = parameters["phase"]
    rows = []
    paths = []
    for amplitude in amplitudes:
        velocity = amplitude * np.cos(phase) + r * parameters["impact_speed"]
        path = restitution.iterate(r, amplitude, phase, velocity, parameters["impacts"])
        paths.append(path)
        impacts, periods = restitution.repetition(path)
        exponent = (np.nan, np.nan)
        if not impacts and not path.stickings:
            exponent = restitution.lyapunov_exponent(path)
        rows.append((impacts, periods, path.stickings, *exponent))
    columns = [("amplitude", list(column)) for column in zip(*rows, strict=True)]
    return xr.Dataset(
        {
            **dict(zip(OF_A_BALL, columns, strict=True)),
            "impact_time": (("amplitude", "impact"), [path.time[:FIRST] for path in paths]),
            "impact_bounce": (("amplitude", "impact"), [path.velocity[:FIRST] for path in paths]),
        },
        {"amplitude": amplitudes, "impact": np.arange(FIRST)},
    )


STAGE = {"fig02": fig02, "fig03": fig03, "three_balls": three_balls}
