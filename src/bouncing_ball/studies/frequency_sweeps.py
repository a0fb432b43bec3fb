"""Stable n-T orbits of the spring-damper model along ϖ (Figs. 5, 6, 10, 13)."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.variables import describe
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.spring_damper_limits import orbit_at
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.studies.columns import OBSERVED, columns
from bouncing_ball.studies.parameters import grid

# Relative distance of two frequency ratios that are one but for the rounding of a grid.
_ROUNDING = 1e-12


def sweep(
    n: int, restitution: np.ndarray, amplitude: np.ndarray, ratios: np.ndarray, release: str
) -> SpringDamperOrbit:
    """Orbits on the stable side, shape (cases, ϖ); NaN where there is none."""
    contact = SpringDamper.from_restitution(restitution[:, np.newaxis], ratios, release)
    return orbit_at(contact, n, amplitude[:, np.newaxis])


def with_round_values(ratios: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A grid of ϖ with 2, 5 and the decades of its range, and where these are.

    A sample that is one of them but for rounding makes room for it.

    Examples
    --------
    >>> ratios, labelled = with_round_values(np.array([1.0, 4.0, 10.0 + 1e-14]))
    >>> ratios.tolist(), labelled.tolist()
    ([1.0, 2.0, 4.0, 5.0, 10.0], [True, True, False, True, True])
    """
    decades = 10.0 ** np.arange(np.floor(np.log10(ratios[0])), np.log10(ratios[-1]) + 1)
    round_values = np.union1d(decades, [2.0, 5.0])
    inside = (round_values >= ratios[0] * (1 - _ROUNDING)) & (
        round_values <= ratios[-1] * (1 + _ROUNDING)
    )
    round_values = round_values[inside]
    distance = np.abs(ratios[:, np.newaxis] / round_values - 1)
    kept = ratios[np.all(distance > _ROUNDING, axis=1)]
    merged = np.union1d(kept, round_values)
    return merged, np.isin(merged, round_values)


def _sweep_dataset(parameters, restitution, amplitude, release, ratios=None) -> xr.Dataset:
    n = parameters["n"]
    ratios = grid(parameters["frequency_ratio"]) if ratios is None else ratios
    orbits = sweep(n, restitution, amplitude, ratios, release)
    found = columns(orbits, *OBSERVED, "max_height")
    dims = ("case", "frequency_ratio")
    return xr.Dataset(
        {
            "restitution": ("case", restitution),
            "amplitude": ("case", amplitude),
            **{name: (dims, values) for name, values in found.items()},
        },
        coords={"frequency_ratio": ratios, "case": np.arange(len(restitution))},
    )


def apparent_restitution(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """r_a along ϖ for ``cases`` of (r, Λ) (Eq. 17; Figs. 5 and 6)."""
    cases = parameters["cases"]
    restitution = np.array([case["restitution"] for case in cases], dtype=float)
    amplitude = np.array([case["amplitude"] for case in cases], dtype=float)
    return describe(_sweep_dataset(parameters, restitution, amplitude, release))


def frequency_sweep(
    parameters: Mapping[str, Any], release: str, ratios: np.ndarray | None = None
) -> xr.Dataset:
    """The orbits along ϖ for one r and several Λ, with their restitution
    limits (Fig. 10); at other ϖ than the configured ones, if given."""
    amplitude = np.array(parameters["amplitude"], dtype=float)
    r = parameters["restitution"]
    restitution = np.full_like(amplitude, r)
    dataset = _sweep_dataset(parameters, restitution, amplitude, release, ratios)
    n = parameters["n"]
    dataset["restitution_phase"] = ("case", restitution_orbits.phase(n, r, amplitude))
    dataset["restitution_bounce_velocity"] = ((), n * np.pi)
    dataset["restitution_impact_velocity"] = ((), -n * np.pi)
    return describe(dataset)


def poincare_map(parameters: Mapping[str, Any], release: str) -> xr.Dataset:
    """The same at round ϖ too, which are labelled in Fig. 13."""
    ratios, labelled = with_round_values(grid(parameters["frequency_ratio"]))
    dataset = frequency_sweep(parameters, release, ratios)
    return describe(dataset.assign(labelled=("frequency_ratio", labelled)))
