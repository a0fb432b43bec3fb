"""From which ϖ on the means over a motion are right, over (Λ, r) (beyond the paper)."""

from typing import Annotated

import numpy as np
import xarray as xr
from scipy.stats import t as student

from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.means import means
from bouncing_ball.attractors.motions import Motions
from bouncing_ball.contacts.spring_damper import Release
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import Seed, Tolerance, number
from bouncing_ball.studies.attractors import SIMPLE, Grid, group, share

DECISIONS = ("from this on", "not at any", "undecided", "no number")
"""What is known of the smallest ϖ: it is known, the largest one is not enough, the interval of
some error contains the tolerance, or the simple model's value is infinite."""
MEANS = ("power", "height", "flights", "exponent")
NODES = ("all", "orbit", "locked", "chaotic")
"""Nodes by what all balls of the simple model end on, of the corrected model at the largest ϖ."""


# Half the width of an interval at least: a motion that repeats is found within 1e-6 of its state.
_KNOWN = 1e-6


class MeanMotions(Grid):
    """A grid over (Λ, r) with several balls for each node, which start alike in all models."""

    starts: Annotated[int, number("balls for each node, which make the interval", ge=3, le=10000)]
    samples: Annotated[
        int, number("impacts of a mean over a motion that does not repeat", ge=10, le=10**7)
    ]
    tolerance: Tolerance
    seed: Seed


def needed(error: np.ndarray, margin: np.ndarray, tolerance: float) -> tuple[np.ndarray, ...]:
    """The place of the smallest ϖ from which on an error is within the tolerance, and what is
    known of it, an index into :data:`DECISIONS`.

    Parameters
    ----------
    error, margin : array
        Errors and half the widths of their intervals, with ϖ along the first axis.

    Examples
    --------
    >>> error = np.array([[0.3], [0.02], [0.001]])
    >>> [x.tolist() for x in needed(error, np.full((3, 1), 0.005), 0.01)]
    [[2], [0]]
    """
    size = np.abs(error)
    within, beyond = (x[::-1] for x in (size + margin <= tolerance, size - margin > tolerance))
    first = np.argmin(np.concatenate([within, np.zeros_like(within[:1])]), axis=0)
    at = np.minimum(first, len(error) - 1)[np.newaxis]
    stopped = np.take_along_axis(beyond, at, axis=0)[0] | (first == len(error))
    decision = np.where(stopped, np.where(first > 0, 0, 1), 2)
    return len(error) - first, np.where(np.isnan(error).any(axis=0), 3, decision)


def mean_motions(parameters: MeanMotions, release: Release) -> xr.Dataset:
    """The smallest ϖ from which on the means of a simple model are right, over (Λ, r).

    The balls of a node start with the same impacts in all models, random in phase and speed. Each
    of them gives a mean over the motion on which it ends, and the paired differences of these give
    the error of the simple model with its interval by Student's distribution, whatever the balls
    end on. ``mean_error`` and ``mean_margin``, half the interval's width, (simple, mean, ϖ,
    restitution, amplitude) are (contact - simple)/simple of the power, height, flights per period
    and exponent. ``needed_ratio`` (simple, mean, restitution, amplitude) is the smallest ϖ of those
    tried from which on all errors are within the tolerance, NaN where ``decision`` is not "from
    this on", see :data:`DECISIONS`. ``needed_share`` (simple, mean, ϖ) is the share of the nodes
    that are known to be right from this ϖ on, of those with a number, with its Wilson limits and
    their number.
    """
    balls = parameters.starts
    lam, compared = parameters.models(release, balls)
    random = np.random.default_rng(parameters.seed)
    phase = random.uniform(-np.pi, np.pi, balls)
    speed = random.uniform(0.0, 4.0, balls) * np.maximum(lam, 1)
    velocity = lam * np.cos(phase) - speed
    values, motions = [], []
    for model in compared:
        found = label(model.impact_law, lam, phase, velocity, impacts=parameters.impacts)
        of = means(model.impact_law, lam, found, parameters.samples)
        exponent = np.where(found.periods > 0, found.exponent, of.exponent)
        values.append(np.stack([of.power, of.height, of.flights, exponent]))
        motions.append(found)
    *simple, contact = (np.broadcast_to(x, values[-1].shape) for x in _with_ratio(values))
    level, ratios = parameters.confidence, parameters.frequency_ratio
    width = student.ppf((1 + level) / 2, balls - 1) / np.sqrt(balls)
    with np.errstate(invalid="ignore"):
        scale = np.array([np.abs(x.mean(axis=-1)) for x in simple])
        apart = np.array([contact - x for x in simple])
        error = apart.mean(axis=-1) / scale
        margin = width * apart.std(axis=-1, ddof=1) / scale
    error, margin = np.where(np.isfinite(error), [error, np.maximum(margin, _KNOWN)], np.nan)
    along = np.moveaxis(np.stack([error, margin]), 3, 1)
    place, known = needed(along[0], along[1], parameters.tolerance)
    least = np.where(known == 0, np.array(ratios)[np.minimum(place, len(ratios) - 1)], np.nan)
    # The first ϖ, in order, from which on each node is known to be right.
    first = np.where(known == 0, place, len(ratios))
    shares = [
        [share(first[s, q][here] <= k, level) for k in range(len(ratios))]
        for s, found in enumerate(motions[:-1])
        for q in range(len(MEANS))
        for name in NODES
        for here in [(known[s, q] < 3) & _all(found, name)]
    ]
    of_shares = ("simple", "mean", "motion_group", "frequency_ratio")
    shape = len(SIMPLE), len(MEANS), len(NODES), len(ratios), 4
    nodes, right, low, high = np.moveaxis(np.reshape(shares, shape), -1, 0)
    dims, of_nodes = ("simple", "mean"), ("restitution", "amplitude")
    return described(
        {
            "mean_error": ((*dims, "frequency_ratio", *of_nodes), error),
            "mean_margin": ((*dims, "frequency_ratio", *of_nodes), margin),
            "needed_ratio": ((*dims, *of_nodes), least),
            "decision": ((*dims, *of_nodes), np.array(DECISIONS)[known]),
            "needed_share": (of_shares, right),
            "needed_low": (of_shares, low),
            "needed_high": (of_shares, high),
            "needed_nodes": (of_shares[:-1], nodes[..., 0]),
        },
        coords={
            "simple": list(SIMPLE),
            "mean": list(MEANS),
            "motion_group": list(NODES),
            "frequency_ratio": list(ratios),
            "restitution": parameters.restitution.grid(),
            "amplitude": parameters.amplitude.grid(),
        },
    )


def _with_ratio(values: list[np.ndarray]) -> list[np.ndarray]:
    """The means of all models with an axis for ϖ, which those of the restitution model lack."""
    return [x if x.ndim == values[-1].ndim else x[:, np.newaxis] for x in values]


def _all(found: Motions, name: str) -> np.ndarray:
    """Whether all balls of a node belong to a group, at the largest ϖ; shape (r, Λ)."""
    inside = np.all(group(found, name), axis=-1)
    return inside.reshape(-1, *inside.shape[-2:])[-1]
