"""Orbit diagrams over the amplitude, and the largest Lyapunov exponents."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.locking import _KNOWN
from bouncing_ball.beyond.exhibits.motion_samples import MODELS, Amplitudes, Impacts, three_models
from bouncing_ball.beyond.long_run.grids import REACH, diagram
from bouncing_ball.datasets.parameters import FrequencyRatio, LossyRestitution, Sharded, number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.paper.contact.damping import Release

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
    impacts: Impacts
    bins: Annotated[int, number("equal ranges of the phase of impact", ge=10, le=2000)]


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
    lam, bins = parameters.amplitude.grid(), parameters.bins
    own = part(np.arange(lam.size))
    # Balls start again from the ends of balls at neighbouring Λ.
    near = np.arange(max(own[0] - REACH, 0), min(own[-1] + REACH + 1, lam.size))
    edges = np.linspace(-np.pi, np.pi, bins + 1)
    columns = []
    for model in three_models(
        np.array(parameters.restitution), parameters.frequency_ratio, release
    ):
        found = diagram(model, lam[near], parameters.starts, parameters.samples, parameters.impacts)
        found = found.isel(amplitude=own - near[0])
        phase = found.impact_phase.values
        at = np.isfinite(phase)
        weight = 1 / np.maximum(at.sum(axis=-1, keepdims=True), 1)
        known = at.any(axis=-1).sum(axis=1)
        place = np.broadcast_to(np.arange(own.size)[:, np.newaxis, np.newaxis], phase.shape)[at]
        density, *_ = np.histogram2d(
            *(phase[at], place),
            bins=(edges, np.arange(own.size + 1) - 0.5),
            weights=np.broadcast_to(weight, phase.shape)[at],
        )
        best = found.isel(start=found.lyapunov_exponent.fillna(-np.inf).argmax("start"))
        exponent, error = best.lyapunov_exponent.fillna(-np.inf), best.lyapunov_error
        columns.append((density / np.maximum(known, 1), exponent, np.fmax(error, _KNOWN)))
    density, exponent, error = (np.stack(x) for x in zip(*columns, strict=True))
    return {"phase_density": density, "lyapunov_exponent": exponent, "lyapunov_error": error}


def orbit_diagrams(parameters: Diagram, release: Release, found: Found = None) -> xr.Dataset:
    """The phases in rad of the impacts on the attractors of each model, over Λ.

    ``phase_density`` (model, amplitude, bin_phase) is the share of the impacts within a range of
    phases, whose middle is ``bin_phase``, averaged over the motions on which the balls of
    :func:`bouncing_ball.beyond.long_run.grids.diagram` end. ``lyapunov_exponent`` (model,
    amplitude) is the largest exponent of these motions, -∞ where all are locked, and
    ``lyapunov_error`` its standard error, which is at least 1e-5.
    """
    found = found or phases_of_impacts(parameters, release)
    edges = np.linspace(-np.pi, np.pi, parameters.bins + 1)
    dims = ("model", "bin_phase", "amplitude")
    return described(
        {x: (dims if y.ndim == 3 else dims[::2], y) for x, y in found.items()},
        coords={
            "model": list(MODELS),
            "amplitude": parameters.amplitude.grid(),
            "bin_phase": (edges[1:] + edges[:-1]) / 2,
        },
        variables=VARIABLES,
    ).transpose("model", "amplitude", ...)
