"""Where balls end over restitution and amplitude, and where the models agree on it."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import LIMITS, MODELS, SIMPLE, Grid, models, share
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.long_run.motions import Kind, Motions
from bouncing_ball.datasets.parameters import number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.paper.contact.damping import Release

VARIABLES = {
    "motion_group": Variable("motions by what the simple model's ball ends on"),
    "agreement": Variable(
        "share of nodes at which the contact's ball ends on a motion of the same kind and period as the simple model's"
    ),
    "agreement_low": Variable("lower limit of the confidence interval of this share"),
    "agreement_high": Variable("upper limit of the confidence interval of this share"),
    "agreement_nodes": Variable("nodes of the group at which both motions are known"),
}


class Locking(Grid):
    """A grid over (Λ, r) with one ball for each node, all of which start alike.

    The maps show the first ϖ; the shares of agreement are computed at every ϖ.
    """

    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]


# A motion repeats within 1e-6 of its state, so that the error of its multipliers is about 1e-6
# times the curvature of the map, which is of order one to ten.
_KNOWN = 1e-5
GROUPS = ("all", "orbit", "subharmonic", "locked", "locked, 1 to 4 T", "locked, above 10 T",
          "chaotic")  # fmt: skip
"""Groups of nodes by the motion on which the ball of the simple model ends; ``all`` also contains
permanent contact."""


def group(found: Motions, name: str) -> np.ndarray:
    """Whether the motions belong to a group of :data:`GROUPS`, an array of their shape."""
    kind, _, which = name.partition(", ")
    inside = found.kind == kind if kind != "all" else np.full(found.kind.shape, True)
    bound = {"1 to 4 T": found.periods <= 4, "above 10 T": found.periods > 10}
    return inside & bound.get(which, True)


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
        The fields of :class:`~bouncing_ball.beyond.long_run.motions.Motions`, shape (model, ϖ, node).
        The restitution model has the same values at every ϖ.
    """
    ratios = np.array(parameters.frequency_ratio)
    r, lam = part(parameters.places())
    start = parameters.phase, lam * np.cos(parameters.phase) - parameters.impact_speed
    found = [
        vars(final_motions(model.impact_law, lam, *start, impacts=parameters.impacts))
        for model in models(r, ratios[:, np.newaxis], release)
    ]
    # The restitution model is the same at every ϖ.
    shape = ratios.size, lam.size
    return {x: np.stack([np.broadcast_to(each[x], shape) for each in found]) for x in found[0]}


def locking(parameters: Locking, release: Release, found: Found = None) -> xr.Dataset:
    """The motions on which balls end over (Λ, r), and where the models agree on them.

    ``kind``, ``periods``, ``impacts``, ``lyapunov_exponent`` and ``lyapunov_error`` (model,
    restitution, amplitude) are those of :func:`bouncing_ball.beyond.long_run.destination.final_motions` at the first
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
        variables=VARIABLES,
    )
