"""Table 1 under every reading, ranked by the distance to the printed values."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.claims.forensics.altered_model import Altered, altered_orbit
from bouncing_ball.claims.forensics.bifurcations import Bifurcations, bifurcations
from bouncing_ball.claims.forensics.readings import Reading, readings
from bouncing_ball.claims.forensics.steps import attainable, nearby, step_needed
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.datasets.rounding import levels
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import ModelError
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.restitution_orbit import ImpactMap
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.studies.printed_table1 import AXES, RESTITUTION, printed_table

BOUNDS = list(Bifurcation)
ALL_ROWS, SOFTER_ROWS = "all rows", "softer rows"


def _model(chosen: list[Reading], parameters: Mapping[str, Any]) -> Altered:
    """The equations of all readings as arrays of shape (readings, rows, families)."""
    printed = parameters["printed"]
    standard = {
        "frequency_ratio": np.array(printed["frequency_ratio"], dtype=float)[:, np.newaxis],
        "damping_ratio": float(damping_ratio(printed["restitution"])),
        "n": np.array(printed["n"], dtype=float),
    }
    shape = (len(printed["frequency_ratio"]), len(printed["n"]))
    models = [Altered(**{**standard, **reading.equations}) for reading in chosen]
    return Altered(
        *(
            np.stack([np.broadcast_to(x, shape) for x in column])
            for column in zip(*models, strict=True)
        )
    )


def _formula(parameters: Mapping[str, Any]) -> np.ndarray:
    """Eqs. 7 and 8 as printed, shape (families, 2)."""
    printed = parameters["printed"]
    n, r = np.array(printed["n"]), printed["restitution"]
    doubling = restitution_orbits.period_doubling(n, r, ImpactMap.HOLMES)
    return np.stack([restitution_orbits.saddle_node(n, r), doubling], axis=-1)


def _groups(ratios: np.ndarray) -> dict[str, np.ndarray]:
    """Which rows are compared together."""
    groups = {ALL_ROWS: np.full(ratios.shape, True), SOFTER_ROWS: ratios < ratios.max()}
    return groups | {f"ϖ = {ratio:g}": ratios == ratio for ratio in ratios}


def _distances(difference: np.ndarray, groups: Mapping[str, np.ndarray]) -> dict[str, tuple]:
    """Distances of every reading over every group of rows.

    Not a number where a reading has no orbit for an entry.
    """
    parts = [difference[:, rows].reshape(len(difference), -1) for rows in groups.values()]
    dims = ("reading", "rows")
    return {
        "largest_difference": (dims, np.stack([np.abs(x).max(axis=-1) for x in parts], axis=-1)),
        "rms_difference": (
            dims,
            np.stack([np.sqrt(np.mean(x * x, axis=-1)) for x in parts], axis=-1),
        ),
        "reproduced": (dims, np.stack([np.sum(np.abs(x) <= 0.5, axis=-1) for x in parts], -1)),
        "entries": ("rows", np.array([x.shape[-1] for x in parts])),
    }


def _rewritten(
    chosen: list[Reading], exact: np.ndarray, parameters: Mapping[str, Any]
) -> np.ndarray:
    """The bifurcations with the rows that a reading takes from Eqs. 7 and 8."""
    ratios = np.array(parameters["printed"]["frequency_ratio"], dtype=float)
    from_formula = np.stack([ratios >= reading.formula_from for reading in chosen])
    return np.where(from_formula[..., np.newaxis, np.newaxis], _formula(parameters), exact)


def _continued(
    chosen: list[Reading], found: Bifurcations, model: Altered, parameters: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray]:
    """Best values of the readings with a step, and the steps needed; NaN elsewhere."""
    printed, half = np.array(parameters["printed"]["values"]), parameters["last_digit"] / 2
    values, needed = np.full((2, *model.n.shape, len(BOUNDS)), np.nan)
    which = np.array([k for k, reading in enumerate(chosen) if reading.step], dtype=int)
    part = Altered(*(np.asarray(x)[which] for x in model))
    for bound, excess in enumerate(found):
        wanted = printed[..., bound]
        arc, amplitude = nearby(excess[which], part, parameters["step_reach"])
        needed[which, ..., bound] = step_needed(arc, amplitude, wanted - half, wanted + half)
        step = np.array([chosen[k].step for k in which])[:, np.newaxis, np.newaxis]
        values[which, ..., bound] = np.clip(wanted, *attainable(arc, amplitude, step))
    return values, needed


def _computed(
    chosen: list[Reading], parameters: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The bifurcations of all readings, the best values of each, and the steps needed."""
    model = _model(chosen, parameters)
    found = bifurcations(model)
    exact = np.stack([altered_orbit(excess, model).amplitude for excess in found], axis=-1)
    values, needed = _continued(chosen, found, model, parameters)
    in_range = np.array([reading.step > 0 for reading in chosen])[:, None, None, None]
    best = np.where(in_range, values, exact)
    return _rewritten(chosen, exact, parameters), _rewritten(chosen, best, parameters), needed


def _order(distance: xr.DataArray, in_range: np.ndarray) -> np.ndarray:
    """The closest to the softer rows first, then to all rows; those that choose their
    values from a range, and those that lack an orbit, behind the others."""
    softer, every = (distance.sel(rows=name).values for name in (SOFTER_ROWS, ALL_ROWS))
    missing = np.isnan(softer)
    # Readings of the stiffest row alone are equal in the softer ones, but for rounding.
    keys = (levels(np.where(np.isnan(x), np.inf, x)) for x in (every, softer))
    return np.lexsort((*keys, in_range, missing))


def forensics(parameters: Mapping[str, Any]) -> xr.Dataset:
    """Table 1 under every reading, the closest reading first.

    Parameters
    ----------
    parameters : mapping
        ``printed_damping_ratio``, ζ as the paper rounds it;
        ``other_damping_ratios`` to try; ``stiff_exponents`` to try for the
        stiffest row; ``steps`` of a continuation, and the arclength
        ``step_reach`` in which a step that would do is looked for;
        ``last_digit``, the unit of the last printed digit.
    printed : mapping
        Table 1 as printed: its ``restitution`` r, its ``frequency_ratio``, ``n``,
        ``bound`` and ``values`` of shape (frequency_ratio, n, bound).

    Returns
    -------
    xarray.Dataset
        ``computed`` and ``difference`` (in last digits) over (reading,
        frequency_ratio, n, bound), sorted by ``rank``: the rms difference over
        the softer rows, as a reading of the stiffest row alone explains nothing of
        the others, then over all. Readings that choose their values from a range,
        with the printed ones in view, come behind the others.

    Raises
    ------
    ModelError
        If the bounds are not a saddle-node and a period doubling, in this order.
    """
    printed = {
        **{name: list(labels) for name, labels in AXES.items()},
        "values": printed_table().values.tolist(),
        "restitution": RESTITUTION,
    }
    if list(printed["bound"]) != BOUNDS:
        raise ModelError(f"printed.bound = {printed['bound']} must be {BOUNDS}")
    parameters, unit = {**parameters, "printed": printed}, parameters["last_digit"]
    entries = np.array(printed["values"], dtype=float)
    ratios = np.array(printed["frequency_ratio"], dtype=float)
    chosen = readings(parameters)
    exact, best, needed = _computed(chosen, parameters)
    in_range = np.array([reading.step > 0 for reading in chosen])
    truncated = np.array([reading.truncated for reading in chosen])[:, None, None, None]
    computed = np.where(truncated, np.floor(best / unit) * unit, best)
    difference = (computed - entries) / unit
    # No orbit has a smaller Λ than the fold: what is printed below it, by more
    # than its digits can hide, is not a point of the branch, whatever is called stable.
    hidden = np.where(truncated[..., 0], 1.0, 0.5)
    unreachable = np.sum((exact - entries)[..., 0] / unit > hidden, axis=(1, 2))
    groups = _groups(ratios)
    dims = ("reading", "frequency_ratio", "n", "bound")
    dataset = xr.Dataset(
        {
            "computed": (dims, computed),
            "printed": (dims[1:], entries),
            "difference": (dims, difference),
            "step_needed": (dims, needed),
            "unreachable": ("reading", unreachable),
            "chosen_in_range": ("reading", in_range),
            "description": ("reading", [reading.description for reading in chosen]),
            **_distances(difference, groups),
        },
        coords={
            "reading": [reading.name for reading in chosen],
            "frequency_ratio": ratios,
            "n": np.array(printed["n"]),
            "bound": BOUNDS,
            "rows": list(groups),
        },
    )
    dataset = dataset.isel(reading=_order(dataset.rms_difference, in_range))
    return describe(dataset.assign(rank=("reading", np.arange(1, len(chosen) + 1))))
