"""Stage: where a ball ends that is laid on the table, on a contact and in the restitution model.

On a contact, a ball that lies on the table follows the steady motion, in which δ is negative up to
Λ_SD (Eq. 33). Above Λ_SD, the contact ends where δ = 0 with δ′ > 0:

    sin(τ - α) = Λ_SD/Λ,  δ′ = √(Λ² - Λ_SD²)/(ϖ² Λ_SD),  tan α = 2ζϖ/(ϖ² - 1).

As ϖ → ∞, this becomes the lift-off of a rigid ball, sin τ = 1/Λ with δ′ = 0. At its end the contact
pulls at the ball, because the release is that of the displacement (Eq. 23).
"""

from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from bouncing_ball.restitution import period_doubling, saddle_node
from bouncing_ball.spring_damper import damping_ratio, permanent_contact
from bouncing_ball_beyond.contacts.balls import FEW_BALLS, Rigid, SpringDamper
from bouncing_ball_beyond.motions.bounces import Balls, Leaving, bounce, fly, reduced
from bouncing_ball_beyond.motions.effort import Effort
from bouncing_ball_beyond.motions.long_term import LOCKED, PERIODIC, PERMANENT, ends_of, times
from bouncing_ball_beyond.periodic.orbits import PeriodicOrbit, orbit
from bouncing_ball_beyond.tables.table import SINE
from paper_replication.datasets import grid

OFFSET = 1e-9
"""Relative difference of Λ between a ball and its neighbour, far above rounding errors."""

APART = 1e-3
"""Difference of the times of impacts above which a ball and its neighbour have separated.

The offset has then grown a million times, and a rounding error to less than 1e-9.
"""

SAME = 1e-3
"""Relative difference of the hops of two motions that count as one."""

SAMPLES = np.linspace(0, 1, 65)[1:-1, np.newaxis]
"""Shares of a flight at which its height is sampled, before the largest one is refined."""


def lift_off(ball: SpringDamper, amplitude: NDArray) -> Balls:
    """Balls before their first impact, after the end of the steady motion in contact."""
    ratio = ball.frequency_ratio
    limit = permanent_contact(ratio, ball.zeta)
    zeros = np.zeros(amplitude.shape)
    phase = np.arctan2(2 * ball.zeta * ratio, ratio**2 - 1) + np.arcsin(limit / amplitude)
    speed = np.sqrt(amplitude**2 - limit**2) / (ratio**2 * limit)
    balls = Balls(ball, amplitude, zeros, phase, zeros)
    time, closing = fly(balls, Leaving(zeros, zeros, zeros, phase, zeros, speed))
    turns, phase = reduced(phase + time)
    return replace(balls, turns=turns, phase=phase, speed=closing)


def put_down(ball: Rigid | SpringDamper, amplitude: NDArray) -> Balls:
    """Balls that touch the table at its phase 0, with its velocity."""
    zeros = np.zeros(amplitude.shape)
    return Balls(ball, amplitude, zeros, zeros, zeros)


def stays_near(balls: Balls, impacts: NDArray) -> NDArray:
    """Whether a ball stays near its neighbour, on a slightly larger Λ, for a number of impacts."""
    near = np.zeros(impacts.size, bool)
    beside = replace(balls, amplitude=balls.amplitude * (1 + OFFSET))
    for count in np.unique(impacts):
        some = np.flatnonzero(impacts == count)
        both = [bounce(neighbours.take(some), count) for neighbours in (balls, beside)]
        at, later = (times(record, after) for record, _, after in both)
        near[some] = np.abs(later - at).max(axis=0) < APART
    return near


def hops(balls: Balls, impacts: NDArray) -> NDArray:
    """Maximum of δ in the flights after a number of impacts of each ball."""
    record, _, _ = bounce(balls, int(impacts.max(initial=0)))
    counted = np.arange(len(record))[:, np.newaxis] < impacts
    _, phase, _, _, duration, gap, w, time = np.moveaxis(record, 1, 0)
    waves = SINE.waves(phase + duration, balls.amplitude)
    time, *state = (values[counted] for values in (time, gap, w, *waves))
    gap, w, *waves = state
    sampled, _, _ = SINE.flights(SAMPLES * time, gap, w, waves)
    top = SAMPLES[sampled.argmax(axis=0), 0] * time
    for _ in range(4):
        _, rate, second = SINE.flights(top, gap, w, waves)
        top = np.clip(top - rate / second, 0, time)
    highest = np.zeros(counted.shape)
    highest[counted], _, _ = SINE.flights(top, gap, w, waves)
    return highest.max(axis=0, initial=0)


def motions(balls: Balls, contacts: int) -> dict[str, NDArray]:
    """Impacts and periods until the motion of each ball repeats, and the height of its hop.

    A ball that stays on the table has no impacts, and repeats after a period. Periods are 0 and the
    height is NaN if a motion has not repeated after a number of contacts, or if the neighbour has
    not stayed near: a rounding error may then decide on which motion the ball ends.
    """
    ends = ends_of(balls, contacts, Effort("laid balls", np.inf), "the balls")
    kind = ends["kind"].astype(str)
    known = np.flatnonzero(np.isin(kind, [PERIODIC, LOCKED]) & (ends["periods"] > 0))
    known = known[stays_near(balls.take(known), ends["followed"][known])]
    hop = np.where(kind == PERMANENT, 0.0, np.nan)
    at_end = replace(balls, phase=ends["end_phase"], speed=ends["end_speed"]).take(known)
    hop[known] = hops(at_end, ends["impacts"][known])
    repeats = {name: np.where(np.isnan(hop), 0, ends[name]) for name in ("impacts", "periods")}
    return repeats | {"hop": hop}


def in_groups(balls: Balls, contacts: int) -> dict[str, NDArray]:
    """The motions of many balls, in groups that are small enough for compiled loops."""
    groups = np.array_split(np.arange(balls.phase.size), 1 + balls.phase.size // FEW_BALLS)
    motions_of_groups = [motions(balls.take(group), contacts) for group in groups]
    return {
        name: np.concatenate([of_group[name] for of_group in motions_of_groups])
        for name in motions_of_groups[0]
    }


def on_contacts(r: float, amplitude: NDArray, ratio: NDArray, contacts: int) -> dict[str, NDArray]:
    """Motions of balls on a grid of contacts, shape (amplitude, ratio)."""
    every, ratios = (values.ravel() for values in np.meshgrid(amplitude, ratio, indexing="ij"))
    ball = SpringDamper(ratios, restitution=r)
    shape = amplitude.size, ratio.size
    laid = {"impacts": np.zeros(shape, int), "periods": np.ones(shape, int)}
    laid |= {"hop": np.zeros(shape), "start_decides": np.zeros(shape, bool)}
    leaves = np.flatnonzero(every > permanent_contact(ratios, ball.zeta))
    for name, values in in_groups(lift_off(ball.rows(leaves), every[leaves]), contacts).items():
        laid[name].flat[leaves] = values
    known = leaves[laid["periods"].flat[leaves] > 0]
    other = in_groups(put_down(ball.rows(known), every[known]), contacts)
    same = np.isclose(laid["hop"].flat[known], other["hop"], rtol=SAME)
    for name in ("impacts", "periods"):
        same &= laid[name].flat[known] == other[name]
    laid["start_decides"].flat[known] = ~same & (other["periods"] > 0)
    return laid


def flying(r: float, amplitude: NDArray, ratio: NDArray) -> NDArray:
    """Hop on the stable 1-T orbit that flies for most of the period, NaN where there is none."""
    every, ratios = (values.ravel() for values in np.meshgrid(amplitude, ratio, indexing="ij"))
    ball = SpringDamper(ratios, restitution=r)
    orbits_or_reasons = orbit(ball, amplitude=every)
    orbits = {
        i: candidate
        for i, candidate in enumerate(orbits_or_reasons)
        if isinstance(candidate, PeriodicOrbit)
    }
    orbits = {i: candidate for i, candidate in orbits.items() if candidate.contact_duration < np.pi}
    stable = [i for i, candidate in orbits.items() if candidate.stable and candidate.admissible]
    phase, speed = np.reshape([[orbits[i].phase, orbits[i].speeds[0]] for i in stable], (-1, 2)).T
    balls = Balls(ball.rows(stable), every[stable], 0 * phase, phase, speed)
    hop = np.full(every.size, np.nan)
    hop[stable] = hops(balls, np.ones(len(stable), int))
    return hop.reshape(amplitude.size, ratio.size)


def along_flying(r: float, positions: int, ratio: NDArray, contacts: int) -> dict[str, float]:
    """Laid balls in the stable range of the flying 1-T orbit above Λ = 1.

    How many have a known motion, how many of these end on the orbit, and the largest height of the
    hops of the others, divided by that on the orbit.
    """
    low, high = max(saddle_node(1, r), 1.0), period_doubling(1, r)
    amplitude = low + (high - low) * (np.arange(positions) + 0.5) / positions
    laid = on_contacts(r, amplitude, ratio, contacts)
    share = laid["hop"] / flying(r, amplitude, ratio)
    known = np.isfinite(share)
    reached = known & (laid["periods"] == 1) & np.isclose(share, 1, rtol=SAME)
    highest = share.max(where=known & ~reached, initial=0.0)
    return {"scan_known": known.sum(), "scan_reached": reached.sum(), "scan_share": highest}


def ext_laid(parameters: dict) -> xr.Dataset:
    """Motions of laid balls on contacts and in the restitution model, by r."""
    amplitude = grid(parameters["amplitude"], np.linspace)
    ratio = grid(parameters["frequency_ratio"])
    shown = np.array(parameters["shown_ratio"])
    contacts = parameters["contacts"]
    plane = ("amplitude", "frequency_ratio")
    datasets = []
    for r in parameters["restitution"]:
        rigid = in_groups(put_down(Rigid(r), amplitude), contacts)
        shown_hop = on_contacts(r, amplitude, shown, contacts)["hop"]
        laid = on_contacts(r, amplitude, ratio, contacts)
        one = xr.Dataset({name: (plane, values) for name, values in laid.items()})
        one["flying_hop"] = plane, flying(r, amplitude, ratio)
        one["threshold_amplitude"] = "frequency_ratio", permanent_contact(ratio, damping_ratio(r))
        one["shown_hop"] = ("amplitude", "shown_ratio"), shown_hop
        for name in ("periods", "hop"):
            one[f"rigid_{name}"] = "amplitude", rigid[name]
        datasets.append(one)
    data = xr.concat(datasets, "restitution")
    scanned = parameters["scan_restitution"]
    given = parameters["scan_positions"], np.array(parameters["scan_ratio"]), contacts
    scan = [along_flying(r, *given) for r in scanned]
    for name in scan[0]:
        data[name] = "scan_restitution", [summary[name] for summary in scan]
    return data.assign_coords(
        scan_restitution=scanned,
        restitution=parameters["restitution"],
        amplitude=amplitude,
        frequency_ratio=ratio,
        shown_ratio=shown,
    )


STAGE = {"ext_laid": ext_laid}
