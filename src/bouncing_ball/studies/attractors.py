"""The motions on which balls end in the three models: over (Λ, r), and over Λ (beyond the paper).

If a motion is chaotic, or lies next to the boundary of a basin, rounding errors decide its course
after some tens of impacts. Datasets therefore contain the kinds of motions, and means over many
impacts.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Field
from scipy.stats import binomtest

from bouncing_ball.accuracy.errors import models as of_contact
from bouncing_ball.attractors.labelled import REACH, diagram
from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.motions import Kind, Motions
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import (
    Amplitude,
    AmplitudeMax,
    FrequencyRatio,
    Interval,
    LossyRestitution,
    Many,
    Sharded,
    listed,
    number,
)

Confidence = Annotated[float, number("level of the confidence intervals", gt=0.5, lt=1)]
Impacts = Annotated[int, listed("Impacts")]


class Even(Interval):
    """Equally spaced values of a parameter, both ends included."""

    samples: Annotated[int, number("number of values, both ends included", ge=2, le=2001)]

    def grid(self) -> np.ndarray:
        """The values, shape (samples,)."""
        return np.linspace(self.min, self.max, self.samples)


class Amplitudes(Even):
    """Equally spaced amplitudes Λ > 0 of the table's acceleration, at most 100 g."""

    min: Annotated[Amplitude, Field(description="smallest Λ")]
    max: Annotated[AmplitudeMax, Field(description="largest Λ, above min")]


class Restitutions(Even):
    """Equally spaced restitution coefficients r, of which none is elastic."""

    min: Annotated[LossyRestitution, Field(description="smallest r")]
    max: Annotated[LossyRestitution, Field(description="largest r, above min")]


class Grid(Sharded):
    """A grid over (Λ, r), and contacts at several ϖ."""

    amplitude: Amplitudes
    restitution: Restitutions
    frequency_ratio: Many[FrequencyRatio]
    impacts: Impacts
    confidence: Confidence

    def places(self) -> np.ndarray:
        """r and Λ of all nodes, those with one r after each other, shape (2, nodes)."""
        axes = np.meshgrid(self.restitution.grid(), self.amplitude.grid(), indexing="ij")
        return np.reshape(axes, (2, -1))

    def unfolded(self, values: np.ndarray) -> np.ndarray:
        """Values over all nodes, their last axis, over (restitution, amplitude)."""
        shape = self.restitution.samples, self.amplitude.samples
        return values.reshape(*values.shape[:-1], *shape)


class Locking(Grid):
    """A grid over (Λ, r) with one ball for each node, all of which start alike.

    The maps show the first ϖ; the shares of agreement are computed at every ϖ.
    """

    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]


# A motion repeats within 1e-6 of its state, so that the error of its multipliers is about 1e-6
# times the curvature of the map, which is of order one to ten.
_KNOWN = 1e-5


class Diagram(Sharded):
    """Several balls at each of many amplitudes of one contact."""

    restitution: LossyRestitution
    frequency_ratio: FrequencyRatio
    amplitude: Amplitudes
    starts: Annotated[int, number("starts at each Λ beside those of the neighbours", ge=1, le=100)]
    samples: Annotated[int, number("impacts of a motion that does not repeat", ge=10, le=10000)]
    impacts: Impacts
    bins: Annotated[int, number("equal ranges of the phase of impact", ge=10, le=2000)]


SIMPLE = ("restitution", "corrected")
MODELS = (*SIMPLE, "spring-damper")
LIMITS = ("", "_low", "_high")
"""Suffixes of the names of an estimate and of the two limits of its interval."""
GROUPS = ("all", "orbit", "subharmonic", "locked", "locked, 1 to 4 T", "locked, above 10 T",
          "chaotic")  # fmt: skip
"""Groups of nodes by the motion on which the ball of the simple model ends; ``all`` also contains
permanent contact."""


def models(restitution: np.ndarray, ratio: float | np.ndarray, release: Release) -> tuple:
    """Restitution, corrected and spring-damper model with the r of a free impact on the contact.

    Parameters
    ----------
    restitution, ratio : array_like
        r by Eq. 16, which gives the contact its ζ, and ϖ. They broadcast.
    release : Release
        The rule that ends the contact.

    Returns
    -------
    tuple of ImpactModel
        In the order of :data:`MODELS`. The restitution model has the shape of r, the others that to
        which r and ϖ broadcast.
    """
    exact, *simple = of_contact(SpringDamper.from_restitution(restitution, ratio, release))
    return *simple, exact


def group(found: Motions, name: str) -> np.ndarray:
    """Whether the motions belong to a group of :data:`GROUPS`, an array of their shape."""
    kind, _, which = name.partition(", ")
    inside = found.kind == kind if kind != "all" else np.full(found.kind.shape, True)
    bound = {"1 to 4 T": found.periods <= 4, "above 10 T": found.periods > 10}
    return inside & bound.get(which, True)


def share(chosen: np.ndarray, confidence: float) -> tuple[float, float, float, float]:
    """The number of truth values, the share of those that are true, and its Wilson limits.

    The limits hold for independent values. The share and its limits are NaN if there are no values.

    Parameters
    ----------
    chosen : array of bool
        Of any shape.
    confidence : float
        The probability with which the interval contains the share, in (0, 1).

    Returns
    -------
    tuple of float
        Number, share, lower limit and upper limit.

    Examples
    --------
    >>> count, found, low, high = share(np.array([True, False, True, False]), 0.95)
    >>> count, found, round(float(low + high), 12)
    (4, 0.5, 1.0)
    """
    if not chosen.size:
        return 0, np.nan, np.nan, np.nan
    tested = binomtest(int(chosen.sum()), chosen.size)
    return chosen.size, tested.statistic, *tested.proportion_ci(confidence, "wilson")


def with_limits(estimates: dict[str, tuple]) -> dict[str, tuple]:
    """The variables of estimates and of their limits, under names with the suffixes :data:`LIMITS`.

    The values of ``estimates`` are pairs of dimensions and arrays, whose last axis holds an
    estimate, its lower limit and its upper limit.

    Examples
    --------
    >>> found = with_limits({"share": ("case", [[0.5, 0.4, 0.6]])})
    >>> {name: values.tolist() for name, (dims, values) in found.items()}
    {'share': [0.5], 'share_low': [0.4], 'share_high': [0.6]}
    """
    return {
        f"{name}{end}": (dims, np.array(values)[..., k])
        for name, (dims, values) in estimates.items()
        for k, end in enumerate(LIMITS)
    }


def agreement(simple: Motions, contact: Motions, confidence: float) -> np.ndarray:
    """Shares of the nodes at which two models have motions of one kind and period.

    Nodes at which one of the motions is undecided are left out. The limits hold for independent
    nodes; the nodes of a regular grid are spread more evenly.

    Returns
    -------
    array
        :func:`share` for each of :data:`GROUPS`, shape (4, groups).
    """
    known = (simple.kind != Kind.UNDECIDED) & (contact.kind != Kind.UNDECIDED)
    same = (simple.kind == contact.kind) & (simple.periods == contact.periods)
    return np.array([share(same[known & group(simple, x)], confidence) for x in GROUPS]).T


def motions_at_nodes(parameters: Locking, release: Release, part: Part = np.asarray) -> Arrays:
    """The motions on which the balls of the nodes end, in each model at each ϖ.

    Returns
    -------
    dict of array
        The fields of :class:`~bouncing_ball.attractors.motions.Motions`, shape (model, ϖ, node).
        The restitution model has the same values at every ϖ.
    """
    ratios = np.array(parameters.frequency_ratio)
    r, lam = part(parameters.places())
    start = parameters.phase, lam * np.cos(parameters.phase) - parameters.impact_speed
    found = [
        vars(label(model.impact_law, lam, *start, impacts=parameters.impacts))
        for model in models(r, ratios[:, np.newaxis], release)
    ]
    # The restitution model is the same at every ϖ.
    shape = ratios.size, lam.size
    return {x: np.stack([np.broadcast_to(each[x], shape) for each in found]) for x in found[0]}


def locking(parameters: Locking, release: Release, found: Found = None) -> xr.Dataset:
    """The motions on which balls end over (Λ, r), and where the models agree on them.

    ``kind``, ``periods``, ``impacts``, ``lyapunov_exponent`` and ``lyapunov_error`` (model,
    restitution, amplitude) are those of :func:`bouncing_ball.attractors.mapper.label` at the first
    ϖ, with one ball for each node; the error of an exponent is at least 1e-5. ``agreement``
    (simple, frequency_ratio, motion_group) is the share of nodes at which the ball of the contact
    ends on a motion of the same kind and period as the ball of the simple model.
    ``agreement_low`` and ``agreement_high`` are the limits of its Wilson interval, and
    ``agreement_nodes`` is the number of nodes of the group at which both motions are known: see
    :func:`agreement`. ``saddle_node_amplitude`` and ``period_doubling_amplitude`` (model,
    restitution) are those of the 1-T orbit.
    """
    ratios, level = np.array(parameters.frequency_ratio), parameters.confidence
    motions = Motions(**(found or motions_at_nodes(parameters, release)))
    pairs = [[(motions[k, m], motions[-1, m]) for m in range(ratios.size)] for k in range(2)]
    shares = [[agreement(*pair, level) for pair in each] for each in pairs]
    dims = ("model", "restitution", "amplitude")
    of_shares = ("simple", "frequency_ratio", "motion_group")
    nodes, *limits = np.moveaxis(np.array(shares), 2, 0)
    r = parameters.restitution.grid()
    first = models(r, ratios[0], release)
    maps = {x: parameters.unfolded(y[:, 0]) for x, y in vars(motions).items()}
    bifurcations = ("saddle_node", "period_doubling")
    ends = {f"{x}_amplitude": [getattr(y, x)(1) for y in first] for x in bifurcations}
    return described(
        {
            **{x: (dims, maps[x]) for x in ("kind", "periods", "impacts")},
            "lyapunov_exponent": (dims, maps["exponent"]),
            "lyapunov_error": (dims, np.maximum(_KNOWN, maps["exponent_error"])),
            **{x: (dims[:2], np.stack([o.amplitude for o in y])) for x, y in ends.items()},
            "agreement_nodes": (of_shares, nodes),
            **{f"agreement{x}": (of_shares, y) for x, y in zip(LIMITS, limits, strict=True)},
        },
        coords={
            "model": list(MODELS),
            "restitution": r,
            "amplitude": parameters.amplitude.grid(),
            "simple": list(SIMPLE),
            "frequency_ratio": list(ratios),
            "motion_group": list(GROUPS),
        },
    )


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
    for model in models(np.array(parameters.restitution), parameters.frequency_ratio, release):
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
    :func:`bouncing_ball.attractors.labelled.diagram` end. ``lyapunov_exponent`` (model,
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
    ).transpose("model", "amplitude", ...)
