"""Where balls end over restitution and amplitude, and where the models agree on it."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import (
    LEAST_ERROR,
    MODELS,
    SIMPLE,
    MostImpacts,
    ParameterPlane,
    three_models,
)
from bouncing_ball.beyond.motions.many_digits import ManyDigits
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
    "agreement_low": Variable(
        "share of nodes at which the contact's ball is known to end on a motion of the same kind "
        "and period as the simple model's"
    ),
    "agreement_high": Variable("this share if the motions that are not known agreed as well"),
    "agreement_nodes": Variable("nodes of the group at which both motions are known"),
    "many_digits_nodes": Variable(
        "nodes at which the restitution model locks and only many digits tell the period"
    ),
    "chaotic_nodes": Variable(
        "nodes at which the restitution model locks and the contact's ball is chaotic"
    ),
    "chaotic_sticking_nodes": Variable(
        "nodes at which the restitution model locks and the contact's ball is chaotic, although it "
        "has stuck twice"
    ),
    "lasting_nodes": Variable(
        "nodes at which the restitution model locks and the contact's ball is chaotic, also if it "
        "is followed further"
    ),
}


class Locking(ParameterPlane):
    """A grid over (Λ, r) with one ball for each node, all of which start alike.

    The maps show the first ϖ; the shares of agreement are computed at every ϖ.
    """

    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]
    further: Annotated[
        int,
        number(
            "impacts for which contacts that are chaotic, where the restitution model locks, are "
            "followed again",
            ge=200,
            le=100000,
        ),
    ]
    resolved_impacts: MostImpacts


GROUPS = ("all", "orbit", "subharmonic", "locked", "locked, 1 to 4 T", "locked, 5 to 10 T",
          "locked, above 10 T", "locked, unknown period", "chaotic")  # fmt: skip
"""Groups of nodes by the motion on which the ball of the simple model ends; ``all`` also contains
permanent contact. The period of a locked motion is unknown if rounding errors decide on it. It is
then long, because digits are lost on a long way only, so that ``locked, above 10 T`` contains these
motions."""


def group(found: Motions, name: str) -> np.ndarray:
    """Whether the motions belong to a group of :data:`GROUPS`, an array of their shape."""
    if name == "all":
        return np.full(found.kind.shape, True)
    if name == "locked, 1 to 4 T":
        return (found.kind == Kind.LOCKED) & (found.periods >= 1) & (found.periods <= 4)
    if name == "locked, 5 to 10 T":
        return (found.kind == Kind.LOCKED) & (found.periods >= 5) & (found.periods <= 10)
    if name == "locked, above 10 T":
        return (found.kind == Kind.LOCKED) & (found.periods > 10) | found.is_unresolved()
    if name == "locked, unknown period":
        return found.is_unresolved()
    return found.kind == name


def agreement(simple: Motions, contact: Motions) -> np.ndarray:
    """Shares of the nodes at which two models have motions of one kind and period, as bounds.

    At some nodes it is not known whether the motions agree, because one of them is undecided, or
    because both lock and one of the periods is not known. These nodes count as not agreeing
    in the lower bound and as agreeing in the upper one. They are not left out: they are those that
    lose most digits, where the models differ most often.

    Returns
    -------
    array
        Over :data:`GROUPS`, shape (3, groups): the number of nodes at which it is known whether the
        motions agree, and both bounds, NaN for a group without nodes.

    Examples
    --------
    >>> found = Motions.unknown(4)
    >>> found.fill(np.arange(4), kind=Kind.LOCKED, periods=[2, 20, 0, 0])
    >>> agreement(found, found)[:, GROUPS.index("locked, above 10 T")].round(3).tolist()
    [1.0, 0.333, 1.0]
    """
    undecided = (simple.kind == Kind.UNDECIDED) | (contact.kind == Kind.UNDECIDED)
    both_lock = (simple.kind == Kind.LOCKED) & (contact.kind == Kind.LOCKED)
    unresolved = simple.is_unresolved() | contact.is_unresolved()
    known = ~(undecided | (both_lock & unresolved))
    same = known & (simple.kind == contact.kind) & (simple.periods == contact.periods)
    members = np.array([group(simple, name) for name in GROUPS])
    sizes, decided, agreeing = ((members & x).sum(axis=-1) for x in (True, known, same))
    with np.errstate(invalid="ignore"):
        return np.stack([decided, agreeing / sizes, (agreeing + sizes - decided) / sizes])


def motions_at_nodes(parameters: Locking, release: Release, part: Part = np.asarray) -> Arrays:
    """The motions on which the balls of the nodes end, in each model at each ϖ.

    Returns
    -------
    dict of array
        The fields of :class:`~bouncing_ball.long_run.motions.Motions`, shape (model, ϖ,
        node). The restitution model has the same values at every ϖ. Where doubles do not tell the
        period of its locked motion, ``periods`` and ``impacts`` are those by many digits, and
        ``many_digits``, shape (node,), is true. And ``lasts``, shape (ϖ, node): whether the
        restitution model locks, and the contact is chaotic also if it is followed further.
    """
    ratios = np.array(parameters.frequency_ratio)
    r, lam = part(parameters.places())
    phase = parameters.phase
    velocity = lam * np.cos(phase) - parameters.impact_speed
    shape = (ratios.size, lam.size)
    found = []
    for model in three_models(r, ratios[:, np.newaxis], release):
        ends = final_motions(model, lam, phase, velocity, impacts=parameters.impacts)
        found.append({name: np.broadcast_to(values, shape) for name, values in vars(ends).items()})
    arrays = {name: np.stack([one[name] for one in found]) for name in found[0]}
    rigid = MODELS.index("restitution")
    unresolved = Motions(**arrays)[rigid, 0].is_unresolved()
    laps = np.zeros((2, lam.size), dtype=int)
    laps[:, unresolved] = laps_by_many_digits(
        r[unresolved], lam[unresolved], parameters.resolved_impacts
    )
    for name, by_digits in zip(("periods", "impacts"), laps, strict=True):
        arrays[name][rigid] += by_digits
    lasts = chaotic_where_locked(Motions(**arrays))
    of_ratio, node = np.nonzero(lasts)
    contact = three_models(r[node], ratios[of_ratio], release).contact
    further = final_motions(contact, lam[node], phase, velocity[node], impacts=parameters.further)
    lasts[of_ratio, node] = further.kind == Kind.CHAOTIC
    return arrays | {"lasts": lasts, "many_digits": laps[0] > 0}


def laps_by_many_digits(restitution: np.ndarray, amplitude: np.ndarray, impacts: int) -> np.ndarray:
    """Locked orbits of the restitution model, followed with as many digits as they need.

    Parameters
    ----------
    restitution, amplitude : array, shape (balls,)
        r and Λ > 1.
    impacts : int
        Impacts after the lift-off within which the ball is to stick again.

    Returns
    -------
    array of int, shape (2, balls)
        Periods of the table and impacts until the ball sticks again. Both are 0 where it does not
        within so many impacts, or where it grazes the table within the rounding errors of a double.

    Examples
    --------
    The second of these orbits loses 195 digits:

    >>> laps_by_many_digits(np.array([0.6, 0.4]), np.array([3.0, 2.1]), 400).tolist()
    [[13, 259], [33, 311]]
    """
    laps = np.zeros((2, amplitude.size), dtype=int)
    for k, (r, lam) in enumerate(zip(restitution, amplitude, strict=True)):
        stop = ManyDigits(float(r), float(lam)).after_lift_off(impacts)
        if stop is not None:
            laps[:, k] = round(stop.time / (2 * np.pi)), stop.impacts
    return laps


def chaotic_where_locked(motions: Motions) -> np.ndarray:
    """Whether the restitution model locks and the contact is chaotic, shape (ϖ, node).

    The shape of the motions is (model, ϖ, node).
    """
    simple = motions.kind[MODELS.index("restitution")]
    contact = motions.kind[MODELS.index("spring-damper")]
    return (simple == Kind.LOCKED) & (contact == Kind.CHAOTIC)


def locking(parameters: Locking, release: Release, found: Found = None) -> xr.Dataset:
    """The motions on which balls end over (Λ, r), and where the models agree on them.

    ``kind``, ``periods``, ``impacts``, ``lyapunov_exponent`` and ``lyapunov_error`` (model,
    restitution, amplitude) are those of
    :func:`bouncing_ball.long_run.destination.final_motions` at the first ϖ, with one ball
    for each node, but for ``periods`` and ``impacts`` of the restitution model where doubles do not
    tell the period: at ``many_digits_nodes`` nodes they are known by many digits, and at the others
    they are 0. The error of an exponent is at least 1e-5. ``agreement_low`` and
    ``agreement_high`` (simple, frequency_ratio, motion_group) are bounds of the share of nodes at
    which the ball of the contact ends on a motion of the same kind and period as the ball of the
    simple model, and ``agreement_nodes`` is the number of nodes of the group at which it is known:
    see :func:`agreement`. The nodes are a grid and no sample, so that there is no interval.
    ``kind_nodes`` (model, frequency_ratio, motion_group) is the number of nodes at which the ball
    of each model ends on a motion of the group. ``chaotic_nodes`` (frequency_ratio) is the number
    of nodes at which the restitution model locks and the contact is chaotic,
    ``chaotic_sticking_nodes`` the number of these at which the contact has stuck twice or more
    often, and ``lasting_nodes`` that at which it is chaotic also if it is followed ``further``.
    ``saddle_node_amplitude`` and
    ``period_doubling_amplitude`` (model, restitution) are those of the 1-T orbit.
    """
    ratios = np.array(parameters.frequency_ratio)
    arrays = dict(found or motions_at_nodes(parameters, release))
    lasts = arrays.pop("lasts")
    many_digits = arrays.pop("many_digits")
    motions = Motions(**arrays)
    contact = MODELS.index("spring-damper")
    shares = [
        [agreement(motions[simple, ratio], motions[contact, ratio]) for ratio in range(ratios.size)]
        for simple in range(len(SIMPLE))
    ]
    nodes, low, high = np.moveaxis(np.array(shares), 2, 0)
    of_shares = ("simple", "frequency_ratio", "motion_group")

    chaotic = chaotic_where_locked(motions)
    sticks_twice = motions.times_stuck[contact] > 1

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
            "agreement_low": (of_shares, low),
            "agreement_high": (of_shares, high),
            "many_digits_nodes": ((), many_digits.sum()),
            "chaotic_nodes": ("frequency_ratio", chaotic.sum(axis=-1)),
            "chaotic_sticking_nodes": ("frequency_ratio", (chaotic & sticks_twice).sum(axis=-1)),
            "lasting_nodes": ("frequency_ratio", lasts.sum(axis=-1)),
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
