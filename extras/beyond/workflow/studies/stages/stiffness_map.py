"""Stage: how well the error law tells how stiff a contact must be to be stable and as high.

The exact frequency ratios are those of the replication, on nodes (n, r, Λ) of the stable range of
the restitution model. Positions of Λ from saddle-node (0) to period doubling (1) are sin² of
equally spaced angles, so that they are dense at both ends.
"""

import numpy as np
import xarray as xr

from bouncing_ball.continuation import bifurcations
from bouncing_ball.errors import COMPARED, enough_from, orbits_along
from bouncing_ball.orbits import Family
from bouncing_ball.restitution import period_doubling, saddle_node
from bouncing_ball.spring_damper import Contact
from bouncing_ball_beyond.contacts.balls import SpringDamper
from bouncing_ball_beyond.errors.error_law import free_impact, law_errors, law_thresholds
from paper_replication.datasets import grid

LEVELS = (10.0, 20.0, 50.0, 100.0, 200.0, 1000.0)
"""The ϖ of the lines of the figure; that of the paper is added."""

NEXT = 1e-13
"""Share by which Λ is moved into the range."""


def ext_map(parameters: dict) -> xr.Dataset:
    """The ϖ that the height needs, exactly and by the law, and the bifurcations of contacts."""
    span = parameters["restitution"]
    tolerance = parameters["tolerance"]
    r = np.linspace(span["min"], span["max"], span["samples"])
    position = np.sin(np.linspace(0, np.pi / 2, parameters["positions"])) ** 2
    n = np.array(parameters["n"])[:, np.newaxis, np.newaxis]
    low = saddle_node(n, r[:, np.newaxis])
    high = period_doubling(n, r[:, np.newaxis])
    amplitude = low + position * (high - low)
    n_all, r_all, amplitude_all = (
        values.reshape(-1, 1) for values in np.broadcast_arrays(n, r[:, np.newaxis], amplitude)
    )
    contact = Contact.of_restitution(grid(parameters["frequency_ratio"]), r_all)
    family = Family(n_all, contact)
    orbits = orbits_along(family, amplitude_all)
    enough = enough_from(family, orbits, r_all, amplitude_all, tolerance)
    height = COMPARED.index("summit")
    unit = SpringDamper(1.0, restitution=r_all[:, 0])
    # Rounding must not put Λ below the saddle-node.
    inside = amplitude_all[:, 0] * (1 + NEXT)
    by_law = law_thresholds(unit, amplitude=inside, n=n_all[:, 0], tolerance=tolerance)
    nodes = ("n", "restitution", "position")
    data = xr.Dataset(
        {
            "amplitude": (nodes, amplitude),
            "saddle_node_amplitude": (nodes[:2], low[..., 0]),
            "period_doubling_amplitude": (nodes[:2], high[..., 0]),
            "error_threshold": (nodes, enough[height].reshape(amplitude.shape)),
            "threshold_by_law": (nodes, by_law["max_height"].reshape(amplitude.shape)),
        },
        {"n": parameters["n"], "restitution": r, "position": position},
    )
    return data.merge(of_bifurcations(parameters, r))


def of_bifurcations(parameters: dict, r: np.ndarray) -> xr.Dataset:
    """Relative errors of saddle-node and period doubling by ϖ, exactly and by the law."""
    levels = np.unique([*LEVELS, parameters["paper"]])
    n_all, r_all = (
        values.reshape(-1, 1) for values in np.meshgrid(parameters["n"], r, indexing="ij")
    )
    contact = Contact.of_restitution(levels, r_all)
    impact = free_impact(SpringDamper(levels, restitution=r_all), n_all)
    law = law_errors(impact, amplitude=period_doubling(n_all, r_all))
    shape = (len(parameters["n"]), r.size, levels.size)
    variables = {}
    for kind, of_model in (("saddle-node", saddle_node), ("period doubling", period_doubling)):
        name = kind.replace("-", "_").replace(" ", "_")
        on_contact = bifurcations(n_all[:, 0], kind, contact)[0]
        error = on_contact / of_model(n_all, r_all) - 1
        over = ("n", "restitution", "level")
        variables[f"{name}_error"] = (over, error.reshape(shape))
        variables[f"{name}_law"] = (over, (law[name] + np.zeros_like(error)).reshape(shape))
    return xr.Dataset(variables, {"level": levels})


STAGE = {"ext_map": ext_map}
