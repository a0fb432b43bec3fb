"""Where balls end over restitution and amplitude, and where the models agree on it."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import (
    LEAST_ERROR,
    MODELS,
    SIMPLE,
    ParameterPlane,
    share,
    three_models,
)
from bouncing_ball.datasets.parameters import number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind, Motions
from bouncing_ball.models.damping import Release
from bouncing_ball.periodic.one_impact import n_t

VARIABLES = {
    "kind_nodes": Variable("nodes at which the ball of a model ends on a motion of this group"),
    "motion_group": Variable("motions by what the simple model's ball ends on"),
    "agreement": Variable(
        "share of nodes at which the contact's ball ends on a motion of the same kind and "
        "period as the simple model's"
    ),
    "agreement_low": Variable("lower limit of the confidence interval of this share"),
    "agreement_high": Variable("upper limit of the confidence interval of this share"),
    "agreement_nodes": Variable("nodes of the group at which both motions are known"),
}


class Locking(ParameterPlane):
    """A grid over (Λ, r) with one ball for each node, all of which start alike.

    The maps show the first ϖ; the shares of agreement are computed at every ϖ.
    """

    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]


GROUPS = ("all", "orbit", "subharmonic", "locked", "locked, 1 to 4 T", "locked, above 10 T",
          "locked, unknown period", "chaotic")  # fmt: skip
"""Groups of nodes by the motion on which the ball of the simple model ends; ``all`` also contains
permanent contact. The period of a locked motion is unknown if rounding errors decide on it."""


def group(found: Motions, name: str) -> np.ndarray:
    """Whether the motions belong to a group of :data:`GROUPS`, an array of their shape."""
    if name == "all":
        return np.full(found.kind.shape, True)
    if name == "locked, 1 to 4 T":
        return (found.kind == Kind.LOCKED) & (found.periods >= 1) & (found.periods <= 4)
    if name == "locked, above 10 T":
        return (found.kind == Kind.LOCKED) & (found.periods > 10)
    if name == "locked, unknown period":
        return found.is_unresolved()
    return found.kind == name


def agreement(simple: Motions, contact: Motions, confidence: float) -> np.ndarray:
    """Shares of the nodes at which two models have motions of one kind and period.

    Nodes at which one of the motions is undecided are left out, and those at which the simple model
    locks after an unknown period, whatever the contact does, because otherwise only its nodes with
    a contact that does not lock would count. Those at which both lock, and the contact after an
    unknown period, are left out as well. The share of the group whose period is unknown therefore
    is NaN, with no nodes. The limits hold for independent nodes; the nodes of a regular grid are
    spread more evenly.

    Returns
    -------
    array
        :func:`share` for each of :data:`GROUPS`, shape (4, groups).
    """
    undecided = (simple.kind == Kind.UNDECIDED) | (contact.kind == Kind.UNDECIDED)
    both_lock = (simple.kind == Kind.LOCKED) & (contact.kind == Kind.LOCKED)
    unknown = simple.is_unresolved() | (both_lock & contact.is_unresolved())
    known = ~(undecided | unknown)
    same = (simple.kind == contact.kind) & (simple.periods == contact.periods)
    return np.array([share(same[known & group(simple, x)], confidence) for x in GROUPS]).T


def motions_at_nodes(parameters: Locking, release: Release, part: Part = np.asarray) -> Arrays:
    """The motions on which the balls of the nodes end, in each model at each ϖ.

    Returns
    -------
    dict of array
        The fields of :class:`~bouncing_ball.long_run.motions.Motions`, shape (model, ϖ,
        node). The restitution model has the same values at every ϖ.
    """
    ratios = np.array(parameters.frequency_ratio)
    r, lam = part(parameters.places())
    phase = parameters.phase
    velocity = lam * np.cos(phase) - parameters.impact_speed
    found = [
        vars(final_motions(model, lam, phase, velocity, impacts=parameters.impacts))
        for model in three_models(r, ratios[:, np.newaxis], release)
    ]
    shape = (ratios.size, lam.size)
    return {
        name: np.stack([np.broadcast_to(one[name], shape) for one in found]) for name in found[0]
    }


def locking(parameters: Locking, release: Release, found: Found = None) -> xr.Dataset:
    """The motions on which balls end over (Λ, r), and where the models agree on them.

    ``kind``, ``periods``, ``impacts``, ``lyapunov_exponent`` and ``lyapunov_error`` (model,
    restitution, amplitude) are those of
    :func:`bouncing_ball.long_run.destination.final_motions` at the first ϖ, with one ball
    for each node; the error of an exponent is at least 1e-5. ``agreement`` (simple,
    frequency_ratio, motion_group) is the share of nodes at which the ball of the contact ends on a
    motion of the same kind and period as the ball of the simple model. ``agreement_low`` and
    ``agreement_high`` are the limits of its Wilson interval, and ``agreement_nodes`` is the number
    of nodes of the group at which both motions are known: see :func:`agreement`.
    ``kind_nodes`` (model, frequency_ratio, motion_group) is the number of nodes at which the ball
    of each model ends on a motion of the group. ``saddle_node_amplitude`` and
    ``period_doubling_amplitude`` (model, restitution) are those of the 1-T orbit.
    """
    ratios = np.array(parameters.frequency_ratio)
    motions = Motions(**(found or motions_at_nodes(parameters, release)))
    contact = MODELS.index("spring-damper")
    shares = [
        [
            agreement(motions[simple, ratio], motions[contact, ratio], parameters.confidence)
            for ratio in range(ratios.size)
        ]
        for simple in range(len(SIMPLE))
    ]
    nodes, share_of_nodes, low, high = np.moveaxis(np.array(shares), 2, 0)
    of_shares = ("simple", "frequency_ratio", "motion_group")

    dims = ("model", "restitution", "amplitude")
    at_first_ratio = {
        name: parameters.unfolded(values[:, 0]) for name, values in vars(motions).items()
    }
    r = parameters.restitution.grid()
    models = three_models(r, ratios[0], release)
    saddle_nodes = [n_t.saddle_node(model, 1).amplitude for model in models]
    period_doublings = [n_t.period_doubling(model, 1).amplitude for model in models]
    return described(
        {
            "kind": (dims, at_first_ratio["kind"]),
            "periods": (dims, at_first_ratio["periods"]),
            "impacts": (dims, at_first_ratio["impacts"]),
            "lyapunov_exponent": (dims, at_first_ratio["exponent"]),
            "lyapunov_error": (dims, np.maximum(LEAST_ERROR, at_first_ratio["exponent_error"])),
            "kind_nodes": (("model", "frequency_ratio", "motion_group"), _numbers(motions)),
            "saddle_node_amplitude": (("model", "restitution"), np.stack(saddle_nodes)),
            "period_doubling_amplitude": (("model", "restitution"), np.stack(period_doublings)),
            "agreement_nodes": (of_shares, nodes),
            "agreement": (of_shares, share_of_nodes),
            "agreement_low": (of_shares, low),
            "agreement_high": (of_shares, high),
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


def _numbers(motions: Motions) -> np.ndarray:
    """The numbers of nodes in each of :data:`GROUPS`, from motions over (model, ϖ, node)."""
    return np.stack([group(motions, name).sum(axis=-1) for name in GROUPS], axis=-1)
