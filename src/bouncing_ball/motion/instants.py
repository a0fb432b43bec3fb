r"""Impacts with a restitution coefficient: flight, impact, chattering, sticking.

An impact turns δ′ into ``-r δ′`` (Eq. 5). Where the table recedes with less
than gravity, g = 1 - Λ sin τ > 0, ever smaller bounces pile up in a finite
time: for v = δ′ after an impact, with g growing at the rate ``g′ = -Λ cos τ``,

    T = T₀ (1 - g′ T₀/(3g) + ...),    T₀ = 2v/(g (1 - r))

This sum replaces the bounces once Λ T₀ and T₀ are below 10⁻⁵ g, where the
next term is below 10⁻¹⁵. The ball then sticks to the table until it lifts off,
at Λ sin τ = 1 on the way up; for Λ ≤ 1 it stays for ever.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.ensembles import blocks, flatten, pick
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import check_amplitude

# Λ T₀/g and T₀/g below which chattering is summed up.
_CHATTER = 1e-5
# Nor is a time that no clock shows worth resolving, where g is tiny (Λ next to 1).
_INSTANT = np.finfo(float).eps


class Rebound(NamedTuple):
    """What follows an impact: time until the ball leaves, δ′ and the table's
    (Λ cos, Λ sin, phase) then, the time of settling, and whether it stays for ever."""

    duration: np.ndarray
    velocity: np.ndarray
    x: np.ndarray
    y: np.ndarray
    phase: np.ndarray
    settling: np.ndarray
    forever: np.ndarray


class ImpactCycle(NamedTuple):
    """Just after the next impact: phase in [-π, π], absolute velocity; time until it.

    NaN, with an infinite time, for a ball that never leaves the table.
    """

    phase: np.ndarray
    velocity: np.ndarray
    time: np.ndarray


def lift_off_phase(amplitude: ArrayLike) -> np.ndarray:
    """Phase arcsin(1/Λ) at which a ball at rest leaves the table; NaN for Λ ≤ 1.

    Examples
    --------
    >>> bool(np.isclose(lift_off_phase(2.0), np.pi / 6))
    True
    """
    lam = np.asarray(amplitude, dtype=float)
    return np.where(lam > 1, np.arcsin(1 / np.maximum(lam, 1.0)), np.nan)


def _rebound(phase, velocity, restitution, amplitude) -> Rebound:
    """From δ′ just after an impact to the moment of leaving the table."""
    x, y = table(phase, amplitude)
    gravity = 1 - y
    pressed = (gravity > 0) | ((gravity == 0) & (x <= 0))
    # Where the ball is not pressed, or r = 1, T₀ is not used.
    loss = gravity * (1 - restitution)
    usable = pressed & (loss > 0)
    total = np.where(usable, 2 * velocity, 0.0) / np.where(usable, loss, 1.0)
    limit = np.maximum(_CHATTER * gravity / np.maximum(amplitude, 1.0), _INSTANT)
    short = usable & (total <= limit)
    sticks = short | (pressed & (velocity == 0))
    if not sticks.any():
        none = np.zeros_like(phase)
        return Rebound(none, velocity, x, y, phase, none, sticks)
    correction = np.where(short, x * total, 0.0) / np.where(short, 3 * gravity, 1.0)
    settling = np.where(sticks, total * (1 + correction), 0.0)
    lifts = np.broadcast_to(amplitude > 1, phase.shape)
    lift = np.where(lifts, np.arcsin(1 / np.maximum(amplitude, 1.0)), 0.0)
    wait = np.mod(reduce_angle(lift - (phase + settling)), 2 * np.pi)
    # Rounding must not turn a lift-off that is due now into one a turn later.
    wait = np.where(wait > 2 * np.pi - 1e-9, 0.0, wait)
    duration = np.where(sticks, np.where(lifts, settling + wait, np.inf), 0.0)
    # At lift-off Λ sin τ = 1 exactly.
    away = np.sqrt(np.maximum((amplitude - 1) * (amplitude + 1), 0.0))
    return Rebound(
        duration,
        np.where(sticks, 0.0, velocity),
        np.where(sticks, away, x),
        np.where(sticks, 1.0, y),
        np.where(sticks, lift, phase),
        settling,
        sticks & ~lifts,
    )


def _fly(rebound: Rebound, amplitude):
    """Phase and δ′ of the next impact, and the time of flight."""
    flight = Flight(np.zeros_like(rebound.phase), rebound.velocity, rebound.x, rebound.y, amplitude)
    # From rest, with Λ sin τ ≥ 1: δ ≥ Λ cos τ s³/6 - Λ s⁴/24.
    rest = (rebound.velocity == 0) & (rebound.y >= 1)
    start = np.where(rest, 4 * rebound.x / np.maximum(amplitude, 1.0), 0.0)
    landing = land(flight, np.maximum(start, flight.sure()))
    return reduce_angle(rebound.phase + landing.time), -landing.rate, landing.time


def _prepare(restitution, amplitude, phase, velocity):
    """Flat arrays, with δ′ in place of the absolute velocity."""
    (r, lam), (phase, velocity), shape = flatten([restitution, amplitude], [phase, velocity])
    if not np.all((r > 0) & (r <= 1)):
        raise ModelError(f"restitution coefficient r = {restitution} is not in (0, 1]")
    check_amplitude(lam)
    if not np.all(np.isfinite(phase) & np.isfinite(velocity)):
        raise ModelError("the phase and the velocity of the ball must be finite")
    x, _ = table(phase, lam)
    relative = velocity - x
    # A ball at rest on the table may come out of rounding as sinking by a little.
    if not np.all(relative >= -8 * np.finfo(float).eps * (np.abs(velocity) + lam)):
        raise ModelError("a ball cannot leave the table downwards: v < w′")
    return r, lam, reduce_angle(phase), np.maximum(relative, 0.0), shape


def simulate(
    restitution: ArrayLike,
    amplitude: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    impacts: int,
) -> ImpactSequence:
    """Follow balls through a number of impacts, the one just before included.

    Parameters
    ----------
    restitution, amplitude : array_like
        r in (0, 1] and Λ; arrays give each ball its own.
    phase, velocity : array_like
        Table phase τ and absolute velocity v of the ball just *after* the
        first impact; its velocity before is worked out.
    impacts : int
        Rows of the result, for every ball that does not come to rest for ever.
        The bounces summed up before sticking are not rows.

    Raises
    ------
    ModelError
        If r, Λ or a state is outside its range.

    Examples
    --------
    >>> simulate(0.5, 0.0, 0.0, 4.0, 3).time.tolist()
    [0.0, 8.0, 12.0]
    """
    r, lam, phase, after, shape = _prepare(restitution, amplitude, phase, velocity)
    size = phase.size
    tables = np.full((6, impacts, size), np.nan)
    status = np.zeros(size, dtype=np.int8)
    for part in blocks(size):
        _run(
            pick(r, part), pick(lam, part), phase[part], after[part],
            tables[:, :, part], status[part],
        )  # fmt: skip
    tables = tables.reshape(6, impacts, *shape)
    time, angle, before, duration, thrown, settling = tables
    return ImpactSequence(
        amplitude=np.broadcast_to(np.asarray(amplitude, dtype=float), shape),
        contact=None,
        time=time,
        phase=angle,
        displacement=0 * time,
        relative_velocity=before,
        contact_duration=duration,
        release_displacement=0 * thrown,
        relative_release_velocity=thrown,
        status=status.reshape(shape),
        settling=settling,
    )


def _run(r, lam, phase, after, tables, status) -> None:
    """Fill the tables of one block, impact by impact."""
    time, before = np.zeros_like(phase), -after / r
    alive = np.arange(phase.size)
    for row in range(tables.shape[1]):
        rebound = _rebound(phase, after, r, lam)
        thrown = np.where(rebound.forever, np.nan, rebound.velocity)
        record = (time, phase, before, rebound.duration, thrown, rebound.settling)
        for array, values in zip(tables, record, strict=True):
            array[row, alive] = values
        if rebound.forever.any():
            status[alive[rebound.forever]] = Status.PERMANENT_CONTACT
            going = np.flatnonzero(~rebound.forever)
            r, lam, alive, time = pick(r, going), pick(lam, going), alive[going], time[going]
            rebound = Rebound(*(x[going] for x in rebound))
        if row == tables.shape[1] - 1 or not alive.size:
            break
        phase, before, flown = _fly(rebound, lam)
        time = time + (rebound.duration + flown)
        after = -r * before


def _cycle(restitution, amplitude, phase, velocity):
    """Phase of the next impact, δ′ before it and the time until it, after an impact (τ, v)."""
    r, lam, phase, after, shape = _prepare(restitution, amplitude, phase, velocity)
    out = np.full((3, phase.size), np.nan)
    out[2] = np.inf
    for part in blocks(phase.size):
        here, level = pick(r, part), pick(lam, part)
        rebound = _rebound(phase[part], after[part], here, level)
        going = np.flatnonzero(~rebound.forever)
        rebound = Rebound(*(x[going] for x in rebound))
        landed, before, flown = _fly(rebound, pick(level, going))
        for array, values in zip(out, (landed, before, rebound.duration + flown), strict=True):
            array[part.start + going] = values
    return (row.reshape(shape) for row in out)


def impact_cycle(
    restitution: ArrayLike, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike
) -> ImpactCycle:
    """The exact map (Eq. 5): from just after one impact, (τ, v), to just after the next.

    Examples
    --------
    >>> float(impact_cycle(0.5, 0.0, 0.0, 4.0).velocity)
    2.0
    """
    landed, before, time = _cycle(restitution, amplitude, phase, velocity)
    bounced = table(landed, np.asarray(amplitude))[0] - np.asarray(restitution) * before
    return ImpactCycle(landed, bounced, time)


def section_cycle(
    restitution: ArrayLike, amplitude: ArrayLike, phase: ArrayLike, relative_velocity: ArrayLike
) -> Cycle:
    """The same map on the section of all models: (φ, δ′) just before the impacts.

    Examples
    --------
    >>> float(section_cycle(0.5, 0.0, 0.0, -4.0).relative_velocity)
    -2.0
    """
    table_velocity, _ = table(np.asarray(phase, dtype=float), np.asarray(amplitude, dtype=float))
    after = table_velocity - np.asarray(restitution) * np.asarray(relative_velocity)
    landed, before, time = _cycle(restitution, amplitude, phase, after)
    return Cycle(landed, before, 0 * before, time)
