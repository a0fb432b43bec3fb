"""Whether balls of the restitution model that seem chaotic lock after long transients.

After some hundreds of impacts many balls of the restitution model have neither repeated nor stuck
to the table twice, or have stuck twice, and doubles do not tell after how many periods they do so
again. Here these balls are followed further, and a sample of them with as many digits as needed.
Whether all of them lock in the end is not decided by any number of impacts.
"""

from typing import Annotated, Any

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import (
    MostImpacts,
    PlaneNodes,
    share_with_limits,
    with_limits,
)
from bouncing_ball.beyond.motions.many_digits import ManyDigits
from bouncing_ball.datasets.parameters import LossyRestitution, Many, Seed, number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.grids import VARIABLES as OF_GRIDS
from bouncing_ball.long_run.motions import Kind, Motions
from bouncing_ball.models.rigid import RestitutionModel

VARIABLES = {
    "band": Variable("range of restitution coefficients"),
    "band_nodes": Variable("nodes of the range at which the ball seems chaotic"),
    "band_low": Variable("lower end of the range of restitution coefficients", symbol="r"),
    "band_high": Variable("upper end of the range of restitution coefficients", symbol="r"),
    "locked_share": Variable("share of the balls that seem chaotic and lock within these impacts"),
    "lap_periods": Variable("periods of the locked orbit by many digits, 0 if none was found"),
    "lap_impacts": Variable("impacts until the ball locks by many digits, 0 if it did not"),
    "lap_digits": Variable("decimal digits that are lost in one period of the locked orbit"),
    "half_locked": Variable(
        "impacts within which half of the balls that seem chaotic have stuck twice, NaN if they "
        "have not within the most impacts"
    ),
    "resolved_share": Variable("share of the sample that locks by many digits"),
    "resolved_share_low": Variable("lower limit of the confidence interval of the locked share"),
    "resolved_share_high": Variable("upper limit of the confidence interval of the locked share"),
    "double_share": Variable("share of the same sample that locks by doubles"),
    "double_share_low": Variable(
        "lower limit of the confidence interval of the share that locks by doubles"
    ),
    "double_share_high": Variable(
        "upper limit of the confidence interval of the share that locks by doubles"
    ),
}


class LongTransients(PlaneNodes):
    """A grid over (Λ, r) with one ball for each node, all of which start alike."""

    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]
    followed: Many[MostImpacts]
    bands: Many[LossyRestitution]
    resolved: Annotated[
        float, number("share of these balls that is followed with many digits", gt=0, le=1)
    ]
    resolved_impacts: MostImpacts
    seed: Seed


def seems_chaotic(found: Motions) -> np.ndarray:
    """Whether doubles show no repetition, but an exponential growth of deviations."""
    return found.is_unresolved() | (found.kind == Kind.CHAOTIC)


def transients_at_nodes(parameters: LongTransients, part: Part = np.asarray) -> Arrays:
    """After how many impacts the balls of the nodes lock.

    Returns
    -------
    dict of array
        Over the node: ``seems_chaotic`` after the fewest impacts; ``locks_after``, the impacts
        until the ball has stuck twice, 0 if it has not within the most; and for the nodes of the
        sample ``lap_impacts``, the same with many digits, ``lap_periods`` and ``lap_digits``; these
        are -1 at all other nodes.
    """
    random = np.random.default_rng(parameters.seed)
    places = parameters.places()
    drawn = np.where(random.random(places.shape[1]) < parameters.resolved, 1.0, 0.0)
    r, lam, drawn = part(np.vstack([places, drawn]))
    phase = parameters.phase
    velocity = lam * np.cos(phase) - parameters.impact_speed
    few = min(parameters.followed)
    found = final_motions(RestitutionModel(r), lam, phase, velocity, impacts=few)
    chaotic = seems_chaotic(found)
    there = np.flatnonzero(chaotic)
    further = final_motions(
        RestitutionModel(r[there]),
        lam[there],
        phase,
        velocity[there],
        impacts=max(parameters.followed),
    )
    locks_after = np.zeros(lam.size, dtype=int)
    locks_after[there] = np.where(further.kind == Kind.LOCKED, further.followed, 0)
    laps = np.full((3, lam.size), -1.0)
    for node in np.flatnonzero(chaotic & (drawn > 0) & (lam > 1)):
        laps[:, node] = _resolved(parameters, r[node], lam[node], velocity[node])
    return {
        "seems_chaotic": chaotic,
        "locks_after": locks_after,
        "lap_impacts": laps[0],
        "lap_periods": laps[1],
        "lap_digits": laps[2],
    }


def _resolved(
    parameters: LongTransients, restitution: float, amplitude: float, velocity: float
) -> tuple[float, float, float]:
    """Impacts until a ball locks, the periods of its lap and the digits lost in it; all are 0 if it
    does not lock.
    """
    ball = ManyDigits(float(restitution), float(amplitude))
    most = parameters.resolved_impacts
    first = ball.after_impact(parameters.phase, float(velocity), most)
    if first is None:
        return 0.0, 0.0, 0.0
    lap = ball.after_lift_off(most - first.impacts)
    if lap is None:
        return 0.0, 0.0, 0.0
    return first.impacts + lap.impacts, np.rint(lap.time / (2 * np.pi)), lap.digits


def long_transients(parameters: LongTransients, found: Found = None) -> xr.Dataset:
    """The shares of balls that seem chaotic and lock after long transients, in the restitution
    model.

    A ball seems chaotic if after the fewest of the given impacts doubles show no repetition, but an
    exponential growth of deviations. ``locked_share`` (band, followed) is the share of these balls
    that have stuck twice within so many impacts, for all r and for ranges of r from ``band_low`` to
    ``band_high``, ``half_locked`` (band) the number of impacts within which half of them have, NaN
    if half of them have not at all, and ``band_nodes`` (band) is their number; the nodes are a
    grid, so that these shares have no interval. A random sample of the balls is followed with as
    many digits as needed: ``resolved_share`` is the share that is known to have stuck twice within
    ``resolved_impacts``, and ``double_share`` the share of the same balls by doubles. Each of these
    two has a lower and an upper limit, ``_low`` and ``_high``. Over ``sample``, the nodes of this
    sample, with the coordinates ``restitution`` and ``amplitude``, there are the results with many
    digits: ``lap_impacts`` until the ball has stuck twice, the ``lap_periods`` of the locked orbit
    and the ``lap_digits`` lost in it.
    """
    found = found or transients_at_nodes(parameters)
    level = parameters.confidence
    r, lam = parameters.places()
    chaotic = found["seems_chaotic"].astype(bool)
    locks_after = found["locks_after"]
    edges = [parameters.restitution.min, *parameters.bands, parameters.restitution.max]
    lows = np.array([edges[0], *edges[:-1]])
    highs = np.array([edges[-1], *edges[1:]])
    shares = []
    nodes = []
    halves = []
    for low, high in zip(lows, highs, strict=True):
        inside = chaotic & (r >= low) & ((r < high) | (high == edges[-1]))
        nodes.append(int(inside.sum()))
        shares.append([_share_within(locks_after[inside], x) for x in parameters.followed])
        halves.append(_half(locks_after[inside]))
    sample = found["lap_impacts"] >= 0
    of_sample = found["lap_impacts"][sample]
    by_doubles = _within(locks_after[sample], parameters.resolved_impacts)
    estimates: dict[str, tuple[Any, Any]] = {
        "resolved_share": ((), share_with_limits(of_sample > 0, level)),
        "double_share": ((), share_with_limits(by_doubles, level)),
    }
    return described(
        {
            "locked_share": (("band", "followed"), shares),
            **with_limits(estimates),
            "half_locked": ("band", halves),
            "band_nodes": ("band", nodes),
            "band_low": ("band", lows),
            "band_high": ("band", highs),
            "lap_impacts": ("sample", of_sample),
            "lap_periods": ("sample", found["lap_periods"][sample]),
            "lap_digits": ("sample", found["lap_digits"][sample]),
        },
        coords={
            "followed": list(parameters.followed),
            "restitution": ("sample", r[sample]),
            "amplitude": ("sample", lam[sample]),
        },
        variables=VARIABLES | {"followed": OF_GRIDS["followed"]},
    )


def _within(locks_after: np.ndarray, impacts: int) -> np.ndarray:
    """Whether balls lock within a number of impacts; 0 stands for those that do not lock."""
    return (locks_after > 0) & (locks_after <= impacts)


def _share_within(locks_after: np.ndarray, impacts: int) -> float:
    """The share of the balls that lock within a number of impacts; NaN for none."""
    return float(_within(locks_after, impacts).mean()) if locks_after.size else np.nan


def _half(locks_after: np.ndarray) -> float:
    """The number of impacts within which half of the balls lock; NaN if fewer do, or for none."""
    if not locks_after.size:
        return np.nan
    last = np.sort(np.where(locks_after > 0, locks_after, np.inf))[(locks_after.size - 1) // 2]
    return float(last) if np.isfinite(last) else np.nan
