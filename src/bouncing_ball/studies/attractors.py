"""What balls end on in the three models: over (Λ, r), and over Λ (beyond the paper).

Where a motion is chaotic, or lies next to the boundary of a basin, rounding decides after some
tens of impacts. Datasets therefore hold what a motion is, and means over many impacts.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import Field
from scipy.stats import binomtest

from bouncing_ball.attractors.labelled import diagram
from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.motions import Kind, Motions
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.parameters import (
    Amplitude,
    AmplitudeMax,
    FrequencyRatio,
    Interval,
    LossyRestitution,
    Many,
    Parameters,
    number,
)

Nodes = Annotated[int, number("equally spaced values, both ends included", ge=2, le=2001)]
Impacts = Annotated[
    int,
    number(
        "impacts after which a ball that has not repeated is given up; an exponent with an error "
        "needs some hundreds",
        ge=200,
        le=100000,
    ),
]


class Amplitudes(Interval):
    """Equally spaced amplitudes."""

    min: Annotated[Amplitude, Field(description="smallest Λ")]
    max: Annotated[AmplitudeMax, Field(description="largest Λ, above min")]
    samples: Nodes

    def grid(self) -> np.ndarray:
        """The amplitudes, shape (samples,)."""
        return np.linspace(self.min, self.max, self.samples)


class Restitutions(Interval):
    """Equally spaced restitution coefficients."""

    min: Annotated[LossyRestitution, Field(description="smallest r")]
    max: Annotated[LossyRestitution, Field(description="largest r, above min")]
    samples: Nodes

    def grid(self) -> np.ndarray:
        """The restitution coefficients, shape (samples,)."""
        return np.linspace(self.min, self.max, self.samples)


class Locking(Parameters):
    """A grid over (Λ, r) with one ball for each node, all of which start alike."""

    amplitude: Amplitudes
    restitution: Restitutions
    frequency_ratio: Annotated[
        Many[FrequencyRatio],
        Field(description="ϖ of the contact; maps are of the first, shares of agreement of all"),
    ]
    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]
    impacts: Impacts
    confidence: Annotated[float, number("level of the confidence intervals", gt=0.5, lt=1)]


# A motion repeats within 1e-6 of its state, so that its multipliers are known to about that times
# the curvature of the map, which is some units.
_KNOWN = 1e-5


class Diagram(Parameters):
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
GROUPS = ("all", "orbit", "subharmonic", "locked", "locked, 1 to 4 T", "locked, above 10 T",
          "chaotic")  # fmt: skip
"""Nodes by what the ball of the simple model ends on; ``all`` has permanent contact as well."""


def models(restitution: np.ndarray, ratio: float, release: Release) -> tuple:
    """Restitution, corrected and spring-damper model, with the r that the contact really has."""
    contact = SpringDamper.from_restitution(restitution, ratio, release)
    return (
        RestitutionModel(contact.restitution),
        CorrectedModel.of_contact(contact),
        SpringDamperModel(contact),
    )


def _group(found: Motions, name: str) -> np.ndarray:
    """Whether the motions belong to a group of :data:`GROUPS`."""
    locked = found.kind == Kind.LOCKED
    match name:
        case "all":
            return np.full(found.kind.shape, True)
        case "locked, 1 to 4 T":
            return locked & (found.periods <= 4)
        case "locked, above 10 T":
            return locked & (found.periods > 10)
        case kind:
            return found.kind == kind


def agreement(simple: Motions, contact: Motions, confidence: float) -> np.ndarray:
    """Shares of the nodes at which two models have motions of one kind and period.

    Parameters
    ----------
    simple, contact : Motions
        Of the same nodes. Those at which one of them is undecided are left out.
    confidence : float
        Level of the interval, Wilson's for independent nodes. Nodes of a regular grid are
        spread more evenly than independent ones.

    Returns
    -------
    array
        For each of :data:`GROUPS` the number of nodes, the share, and its lower and upper
        limit, shape (4, groups); NaN where there is no node.
    """
    known = (simple.kind != Kind.UNDECIDED) & (contact.kind != Kind.UNDECIDED)
    same = (simple.kind == contact.kind) & (simple.periods == contact.periods)
    rows = []
    for name in GROUPS:
        chosen = same[known & _group(simple, name)]
        row = (np.nan, np.nan, np.nan)
        if chosen.size:
            tested = binomtest(int(chosen.sum()), chosen.size)
            row = tested.statistic, *tested.proportion_ci(confidence, "wilson")
        rows.append((chosen.size, *row))
    return np.array(rows).T


def locking(parameters: Locking, release: Release) -> xr.Dataset:
    """The motions on which balls end over (Λ, r), and where the models agree on them.

    ``kind``, ``periods``, ``impacts``, ``lyapunov_exponent`` and ``lyapunov_error`` (model,
    restitution, amplitude) are those of :func:`bouncing_ball.attractors.mapper.label` at the first
    ϖ, one ball for each node; no error of an exponent is below 1e-5. ``agreement`` (simple,
    frequency_ratio, motion_group) is the share of nodes at which the contact's ball ends on a
    motion of the same kind and period as that of the simple model, with ``agreement_low`` and
    ``agreement_high`` of its Wilson interval, and ``agreement_nodes`` the nodes of the group at
    which both are known: see :func:`agreement`. ``saddle_node_amplitude`` and
    ``period_doubling_amplitude`` (model, restitution) are of the 1-T orbit.
    """
    lam, r = parameters.amplitude.grid(), parameters.restitution.grid()
    phase, speed = parameters.phase, parameters.impact_speed
    velocity = lam * np.cos(phase) - speed
    compared, shares = [], []
    first: list[Motions] = []
    for ratio in parameters.frequency_ratio:
        models_here = models(r[:, np.newaxis], ratio, release)
        compared.append(models_here)
        # The restitution model is the same at every ϖ.
        found = first[:1] + [
            label(each.impact_law, lam, phase, velocity, impacts=parameters.impacts)
            for each in models_here[len(first[:1]) :]
        ]
        first = first or found
        shares.append([agreement(one, found[-1], parameters.confidence) for one in found[:-1]])
    found = first
    dims = ("model", "restitution", "amplitude")
    of_shares = ("simple", "frequency_ratio", "motion_group")
    nodes, share, low, high = np.transpose(shares, (2, 1, 0, 3))
    ends = {
        "saddle_node_amplitude": [each.saddle_node(1) for each in compared[0]],
        "period_doubling_amplitude": [each.period_doubling(1) for each in compared[0]],
    }
    return described(
        {
            "kind": (dims, np.stack([each.kind for each in found])),
            "periods": (dims, np.stack([each.periods for each in found])),
            "impacts": (dims, np.stack([each.impacts for each in found])),
            "lyapunov_exponent": (dims, np.stack([each.exponent for each in found])),
            "lyapunov_error": (dims, np.maximum(_KNOWN, [each.exponent_error for each in found])),
            **{
                name: (dims[:2], np.stack([orbit.amplitude[:, 0] for orbit in orbits]))
                for name, orbits in ends.items()
            },
            "agreement": (of_shares, share),
            "agreement_low": (of_shares, low),
            "agreement_high": (of_shares, high),
            "agreement_nodes": (of_shares, nodes),
        },
        coords={
            "model": list(MODELS),
            "restitution": r,
            "amplitude": lam,
            "simple": list(SIMPLE),
            "frequency_ratio": list(parameters.frequency_ratio),
            "motion_group": list(GROUPS),
        },
    )


def orbit_diagrams(parameters: Diagram, release: Release) -> xr.Dataset:
    """Where impacts fall on the attractors of each model over Λ.

    ``phase_density`` (model, amplitude, bin_phase) is the share of the impacts within a range of
    phases, whose middle is ``bin_phase``, averaged over the motions on which the balls of
    :func:`bouncing_ball.attractors.labelled.diagram` end. ``lyapunov_exponent`` (model,
    amplitude) is the largest of the exponents of these, -∞ where all are locked, and
    ``lyapunov_error`` its standard error, 1e-5 at least.
    """
    lam, bins = parameters.amplitude.grid(), parameters.bins
    edges = np.linspace(-np.pi, np.pi, bins + 1)
    columns = []
    for model in models(np.array(parameters.restitution), parameters.frequency_ratio, release):
        found = diagram(model, lam, parameters.starts, parameters.samples, parameters.impacts)
        phase = found.impact_phase.values
        at = np.isfinite(phase)
        weight = 1 / np.maximum(at.sum(axis=-1, keepdims=True), 1)
        known = at.any(axis=-1).sum(axis=1)[:, np.newaxis]
        place = np.broadcast_to(np.arange(lam.size)[:, np.newaxis, np.newaxis], phase.shape)[at]
        density, *_ = np.histogram2d(
            *(place, phase[at]),
            bins=(np.arange(lam.size + 1) - 0.5, edges),
            weights=np.broadcast_to(weight, phase.shape)[at],
        )
        exponent = np.where(np.isnan(found.lyapunov_exponent), -np.inf, found.lyapunov_exponent)
        largest = exponent.argmax(axis=1)[:, np.newaxis]
        error = np.take_along_axis(found.lyapunov_error.values, largest, 1)[:, 0]
        exponent = np.take_along_axis(exponent, largest, 1)[:, 0]
        columns.append((density / np.maximum(known, 1), exponent, np.fmax(error, _KNOWN)))
    density, exponent, error = (np.stack(x) for x in zip(*columns, strict=True))
    return described(
        {
            "phase_density": (("model", "amplitude", "bin_phase"), density),
            "lyapunov_exponent": (("model", "amplitude"), exponent),
            "lyapunov_error": (("model", "amplitude"), error),
        },
        coords={
            "model": list(MODELS),
            "amplitude": lam,
            "bin_phase": (edges[1:] + edges[:-1]) / 2,
        },
    )
