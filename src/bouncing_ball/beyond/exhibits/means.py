"""The ϖ above which a simple model has accurate means over a motion (beyond the paper)."""

from typing import Annotated

import numpy as np
import scipy
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import SIMPLE, ParameterPlane, three_models
from bouncing_ball.datasets.parameters import Seed, Tolerance, number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.means import means
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.damping import Release

VARIABLES = {
    "mean": Variable("mean over the motion on which a ball ends"),
    "mean_error": Variable(
        "difference of the contact's mean from the simple model's, relative to the latter"
    ),
    "mean_margin": Variable("half the width of the confidence interval of this error"),
    "decision": Variable("what is known of this frequency ratio"),
    "right_low": Variable(
        "share of the nodes that are known to be right from this frequency ratio on"
    ),
    "right_high": Variable("share of the nodes that are not known to be wrong from this ratio on"),
    "right_nodes": Variable("nodes at which the simple model's mean is a number"),
}
DECISIONS = ("from this on", "not at any", "undecided", "no number")
"""The result for the smallest ϖ above which a mean is accurate. In this order: it is known; even
the largest ϖ is not enough; the interval of an error contains the tolerance; or the value of the
simple model is infinite."""

MEANS = ("power", "height", "flights", "exponent")
# Speeds of balls at the start are up to this times Λ.
_FASTEST = 4.0
# Lower bound of half the width of an interval: a motion that repeats is found within 1e-6 of its
# state.
_LEAST_MARGIN = 1e-6


class MeanMotions(ParameterPlane):
    """A grid over (Λ, r) with several balls for each node, which start alike in all models."""

    starts: Annotated[int, number("balls for each node, which make the interval", ge=3, le=10000)]
    samples: Annotated[
        int, number("impacts of a mean over a motion that does not repeat", ge=10, le=10**7)
    ]
    tolerance: Tolerance
    seed: Seed


def settled(
    error: np.ndarray, margin: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Whether errors are known to be within a tolerance, and whether they are known to exceed it.

    Examples
    --------
    >>> [x.tolist() for x in settled(np.array([0.002, -0.03, 0.009]), np.full(3, 0.005), 0.01)]
    [[True, False, False], [False, True, False]]
    """
    size = np.abs(error)
    return size + margin <= tolerance, size - margin > tolerance


def needed_index(error: np.ndarray, margin: np.ndarray, tolerance: float) -> tuple[np.ndarray, ...]:
    """The index of the smallest ϖ above which an error is within the tolerance, and whether it is
    known, as an index into :data:`DECISIONS`.

    Parameters
    ----------
    error, margin : array
        Errors and half the widths of their intervals, with ϖ along the first axis.

    Examples
    --------
    >>> error = np.array([[0.3], [0.02], [0.001]])
    >>> [x.tolist() for x in needed_index(error, np.full((3, 1), 0.005), 0.01)]
    [[2], [0]]
    """
    ratios = len(error)
    # From the largest ϖ down to the first ϖ at which the error is not known to be small.
    within, exceeds = (x[::-1] for x in settled(error, margin, tolerance))
    none_within = np.zeros_like(within[:1])
    accurate = np.argmin(np.concatenate([within, none_within]), axis=0)
    first_other = np.minimum(accurate, ratios - 1)[np.newaxis]
    known = np.take_along_axis(exceeds, first_other, axis=0)[0] | (accurate == ratios)
    decision = np.select(
        [np.isnan(error).any(axis=0), known & (accurate > 0), known],
        [
            DECISIONS.index("no number"),
            DECISIONS.index("from this on"),
            DECISIONS.index("not at any"),
        ],
        DECISIONS.index("undecided"),
    )
    return ratios - accurate, decision


def _errors(simple: np.ndarray, contact: np.ndarray, confidence: float) -> np.ndarray:
    """Relative errors of a simple model and half the widths of their intervals, from pairs of balls
    with the same start along the last axis.
    """
    balls = contact.shape[-1]
    width = scipy.stats.t.ppf((1 + confidence) / 2, balls - 1) / np.sqrt(balls)
    with np.errstate(invalid="ignore"):
        difference = contact - simple
        scale = np.abs(simple.mean(axis=-1))
        error = difference.mean(axis=-1) / scale
        margin = width * difference.std(axis=-1, ddof=1) / scale
    margin = np.maximum(margin, _LEAST_MARGIN)
    return np.where(np.isfinite(error), [error, margin], np.nan)


def errors_at_nodes(parameters: MeanMotions, release: Release, part: Part = np.asarray) -> Arrays:
    """The errors of the means of the simple models at each node.

    Returns
    -------
    dict of array
        ``mean_error`` and ``mean_margin`` of :func:`mean_motions`, shape (simple, mean, ϖ, node).
    """
    random = np.random.default_rng(parameters.seed)
    balls = parameters.starts
    unresolved = []
    phase = random.uniform(-np.pi, np.pi, balls)
    speed = random.uniform(0.0, _FASTEST, balls)
    # Arrays over ϖ, the node and the ball.
    r, lam = part(parameters.places())[..., np.newaxis]
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis, np.newaxis]
    velocity = lam * (np.cos(phase) - speed)
    of_models = []
    for model in three_models(r, ratios, release):
        found = final_motions(model, lam, phase, velocity, impacts=parameters.impacts)
        flights, height, power, exponent = means(model, lam, found, parameters.samples)
        repeats = (found.periods > 0) | (found.kind == Kind.LOCKED)
        exponent = np.where(repeats, found.exponent, exponent)
        of_node = found.is_unresolved().any(axis=-1)
        unresolved.append(np.broadcast_to(of_node, (ratios.size, lam.size)))
        values = np.stack([power, height, flights, exponent])
        # The restitution model has one ϖ.
        of_models.append(values.reshape((len(MEANS), -1, lam.size, balls)))
    restitution, corrected, contact = of_models
    restitution_errors = _errors(restitution, contact, parameters.confidence)
    corrected_errors = _errors(corrected, contact, parameters.confidence)
    errors, margins = np.stack([restitution_errors, corrected_errors], axis=1)
    # All balls are then on one lap, which is not the true one, so that their scatter is not the
    # error of the mean.
    *simple, of_contact = unresolved
    for margin, of_simple in zip(margins, simple, strict=True):
        margin[:, of_simple | of_contact] = np.inf
    return {"mean_error": errors, "mean_margin": margins}


def mean_motions(parameters: MeanMotions, release: Release, found: Found = None) -> xr.Dataset:
    """The smallest ϖ above which the means of a simple model are accurate, over (Λ, r).

    The balls of a node start with the same impacts in all models, random in phase and speed. Each
    ball gives a mean over the motion on which it ends, of any kind. The paired differences of these
    means give the error of the simple model, and its interval by Student's distribution.
    ``mean_error`` (simple, mean, ϖ, restitution, amplitude) is (contact - simple)/simple of the
    power, height, flights per period and exponent, and ``mean_margin`` half the width of its
    interval. The margin is infinite where a ball is locked and rounding errors decide on the
    period, because the means are then over another lap than the true one. ``needed_ratio``
    (simple, mean, restitution, amplitude) is the smallest of the given ϖ above which all errors are
    within the tolerance, NaN where ``decision`` is not "from this on"; see :data:`DECISIONS`.
    ``right_low`` (simple, mean, ϖ) is the share of the nodes at which the mean is known to be
    accurate at this ϖ and above, among the ``right_nodes`` where the value of the simple model is
    finite, and ``right_high`` the share of those at which it is not known to be inaccurate. The
    nodes are a grid and no sample, so that there is no interval.
    """
    ratios = np.array(parameters.frequency_ratio)
    found = found or errors_at_nodes(parameters, release)
    error = parameters.unfolded(found["mean_error"])
    margin = parameters.unfolded(found["mean_margin"])
    place, decision = needed_index(
        np.moveaxis(error, 2, 0), np.moveaxis(margin, 2, 0), parameters.tolerance
    )
    known = decision == DECISIONS.index("from this on")
    least = np.where(known, ratios[np.minimum(place, ratios.size - 1)], np.nan)
    counted = decision != DECISIONS.index("no number")
    within, exceeds = settled(error, margin, parameters.tolerance)
    # At this ϖ and above.
    right = np.logical_and.accumulate(within[:, :, ::-1], axis=2)[:, :, ::-1]
    wrong = np.logical_or.accumulate(exceeds[:, :, ::-1], axis=2)[:, :, ::-1]
    counts = counted[:, :, np.newaxis]
    nodes = np.broadcast_to(counts, right.shape).sum(axis=(-2, -1))
    known_right, known_wrong = ((x & counts).sum(axis=(-2, -1)) for x in (right, wrong))
    with np.errstate(invalid="ignore"):
        right_low = known_right / nodes
        right_high = (nodes - known_wrong) / nodes
    dims = ("simple", "mean")
    of_nodes = ("restitution", "amplitude")
    along = (*dims, "frequency_ratio")
    return described(
        {
            "mean_error": ((*along, *of_nodes), error),
            "mean_margin": ((*along, *of_nodes), margin),
            "needed_ratio": ((*dims, *of_nodes), least),
            "decision": ((*dims, *of_nodes), np.array(DECISIONS)[decision]),
            "right_nodes": (along, nodes),
            "right_low": (along, right_low),
            "right_high": (along, right_high),
        },
        coords={
            "simple": list(SIMPLE),
            "mean": list(MEANS),
            "frequency_ratio": ratios,
            "restitution": parameters.restitution.grid(),
            "amplitude": parameters.amplitude.grid(),
        },
        variables=VARIABLES,
    )
