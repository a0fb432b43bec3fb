"""Orbit diagrams over the amplitude, and the largest Lyapunov exponents."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import (
    LEAST_ERROR,
    MODELS,
    Amplitudes,
    MostImpacts,
    three_models,
)
from bouncing_ball.datasets.parameters import FrequencyRatio, LossyRestitution, Sharded, number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.grids import REACH, diagram
from bouncing_ball.models.damping import Release

VARIABLES = {
    "bin_phase": Variable("middle of a range of phases of impact", symbol="φ", units="rad"),
    "phase_density": Variable("share of the impacts on the attractors within a range of phases"),
}


class Diagram(Sharded):
    """Several balls at each of many amplitudes of one contact."""

    restitution: LossyRestitution
    frequency_ratio: FrequencyRatio
    amplitude: Amplitudes
    starts: Annotated[int, number("starts at each Λ beside those of the neighbours", ge=1, le=100)]
    samples: Annotated[int, number("impacts of a motion that does not repeat", ge=10, le=10000)]
    impacts: MostImpacts
    bins: Annotated[int, number("equal ranges of the phase of impact", ge=10, le=2000)]

    def edges(self) -> np.ndarray:
        """The bounds of the ranges of the phase, shape (bins + 1,)."""
        return np.linspace(-np.pi, np.pi, self.bins + 1)


def phases_of_impacts(parameters: Diagram, release: Release, part: Part = np.asarray) -> Arrays:
    """The densities of the impacts' phases and the exponents, in each model along Λ.

    Returns
    -------
    dict of array
        The variables of :func:`orbit_diagrams`: ``phase_density``, shape (model, bin_phase,
        amplitude), and ``lyapunov_exponent`` and ``lyapunov_error``, shape (model, amplitude).

    Raises
    ------
    ModelError
        If there are more balls than fit into memory.
    """
    lam = parameters.amplitude.grid()
    chosen = part(np.arange(lam.size))
    # Balls start again from the ends of balls at neighbouring Λ.
    first = max(chosen[0] - REACH, 0)
    near = np.arange(first, min(chosen[-1] + REACH + 1, lam.size))
    densities = []
    exponents = []
    errors = []
    models = three_models(np.array(parameters.restitution), parameters.frequency_ratio, release)
    for model in models:
        found = diagram(model, lam[near], parameters.starts, parameters.samples, parameters.impacts)
        found = found.isel(amplitude=chosen - first)
        densities.append(_phase_density(found.impact_phase.values, parameters.edges()))
        largest = found.lyapunov_exponent.fillna(-np.inf).argmax("start")
        best = found.isel(start=largest)
        exponents.append(best.lyapunov_exponent.fillna(-np.inf))
        errors.append(np.fmax(best.lyapunov_error, LEAST_ERROR))
    return {
        "phase_density": np.stack(densities),
        "lyapunov_exponent": np.stack(exponents),
        "lyapunov_error": np.stack(errors),
    }


def _phase_density(phase: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Shares of the impacts in ranges of the phase, shape (range, amplitude).

    ``phase`` are the phases of the impacts on each motion, shape (amplitude, start, impact), NaN
    beyond its impacts. All motions at one Λ have equal weights.
    """
    seen = np.isfinite(phase)
    weight = 1 / np.maximum(seen.sum(axis=-1, keepdims=True), 1)
    motions = seen.any(axis=-1).sum(axis=1)
    amplitudes = len(phase)
    place = np.broadcast_to(np.arange(amplitudes)[:, np.newaxis, np.newaxis], phase.shape)
    density, _, _ = np.histogram2d(
        phase[seen],
        place[seen],
        bins=(edges, np.arange(amplitudes + 1) - 0.5),
        weights=np.broadcast_to(weight, phase.shape)[seen],
    )
    return density / np.maximum(motions, 1)


def orbit_diagrams(parameters: Diagram, release: Release, found: Found = None) -> xr.Dataset:
    """The phases in rad of the impacts on the attractors of each model, over Λ.

    ``phase_density`` (model, amplitude, bin_phase) is the share of the impacts within a range of
    phases, whose middle is ``bin_phase``, averaged over the motions on which the balls of
    :func:`bouncing_ball.long_run.grids.diagram` end. ``lyapunov_exponent`` (model,
    amplitude) is the largest exponent of these motions, -∞ where all are locked, and
    ``lyapunov_error`` its standard error, which is at least 1e-5.
    """
    found = found or phases_of_impacts(parameters, release)
    edges = parameters.edges()
    return described(
        {
            "phase_density": (("model", "bin_phase", "amplitude"), found["phase_density"]),
            "lyapunov_exponent": (("model", "amplitude"), found["lyapunov_exponent"]),
            "lyapunov_error": (("model", "amplitude"), found["lyapunov_error"]),
        },
        coords={
            "model": list(MODELS),
            "amplitude": parameters.amplitude.grid(),
            "bin_phase": (edges[1:] + edges[:-1]) / 2,
        },
        variables=VARIABLES,
    ).transpose("model", "amplitude", ...)
