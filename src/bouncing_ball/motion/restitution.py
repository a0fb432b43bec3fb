r"""Impacts with a restitution coefficient: flight, impact, chattering, sticking.

An impact turns δ′ into ``-r δ′`` (Eq. 5). Where the table recedes with less
than gravity, g = 1 - Λ sin τ > 0, ever smaller bounces pile up in a finite
time: for v = δ′ after an impact, with g growing at the rate ``g′ = -Λ cos τ``,

    T = T₀ (1 - g′ T₀/(3g) + ...),    T₀ = 2v/(g (1 - r))

This sum replaces the bounces once Λ T₀ and T₀ are below 10⁻⁵ g, where the
next term is below 10⁻¹⁵. The ball then sticks to the table until it lifts off,
at Λ sin τ = 1 on the way up; for Λ ≤ 1 it stays for ever.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.restitution_law import RestitutionLaw
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import reduce_angle, table
from bouncing_ball.motion.ensembles import BLOCK, flatten, pick
from bouncing_ball.motion.follow import Columns, follow, next_impact
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.rest import lift_off, pressed
from bouncing_ball.motion.sequence import Cycle, ImpactSequence, Status
from bouncing_ball.motion.starts import check_amplitude

# Λ T₀/g and T₀/g below which chattering is summed up.
_CHATTER = 1e-5
# A time that no clock shows is not worth resolving either, where g is tiny (Λ next to 1).
_INSTANT = np.finfo(float).eps


class _Impact(NamedTuple):
    """Impacts: table phase, δ = 0, δ′ before and after."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    after: np.ndarray


class _Rebound(NamedTuple):
    """What follows impacts: table phase, δ = 0 and δ′ when the ball leaves, the time
    until then, the :class:`Status`, the table's Λ cos and Λ sin, a time of flight without
    landing, the time of settling."""

    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    duration: np.ndarray
    status: np.ndarray
    x: np.ndarray
    y: np.ndarray
    flown: np.ndarray
    settling: np.ndarray

    def take(self, which: Any) -> "_Rebound":
        return _Rebound(*(x[which] for x in self))


class ImpactCycle(NamedTuple):
    """Just after the next impact: phase in [-π, π], absolute velocity; time until it.

    NaN, with an infinite time, for a ball that never leaves the table.
    """

    phase: np.ndarray
    velocity: np.ndarray
    time: np.ndarray


class _Instants(NamedTuple):
    """The :class:`~bouncing_ball.motion.follow.Dynamics` of the restitution model."""

    restitution: np.ndarray
    amplitude: np.ndarray
    law: RestitutionLaw | None = None
    """Gives r of every impact but the first, where it depends on the speed."""
    block: int = BLOCK

    @property
    def columns(self) -> Columns:
        return {"settling": lambda _, rebound: rebound.settling}

    def take(self, which: Any) -> "_Instants":
        law = None if self.law is None else self.law.take(which)
        return _Instants(pick(self.restitution, which), pick(self.amplitude, which), law)

    def at(self, speed: np.ndarray) -> np.ndarray:
        """r of impacts with speeds v ≥ 0."""
        if self.law is None:
            return self.restitution
        return self.law.restitution(np.maximum(speed, np.finfo(float).tiny))

    def start(self, phase: np.ndarray, velocity: np.ndarray) -> _Impact:
        """Just after an impact."""
        return _Impact(phase, np.zeros_like(phase), -velocity / self.restitution, velocity)

    def depart(self, impact: _Impact) -> _Rebound:
        phase, velocity, amplitude = impact.phase, impact.after, self.amplitude
        x, y = table(phase, amplitude)
        none = np.zeros_like(phase)
        gravity, down = 1 - y, pressed(x, y)
        # Where the ball is not pressed, or r = 1, T₀ is not used.
        loss = gravity * (1 - self.at(-impact.velocity))
        usable = down & (loss > 0)
        total = np.where(usable, 2 * velocity, 0.0) / np.where(usable, loss, 1.0)
        limit = np.maximum(_CHATTER * gravity / np.maximum(amplitude, 1.0), _INSTANT)
        short = usable & (total <= limit)
        sticks = short | (down & (velocity == 0))
        status = np.zeros(phase.shape, dtype=np.int8)
        flown = np.zeros_like(phase)
        if not sticks.any():
            return _Rebound(phase, none, velocity, none, status, x, y, flown, none)
        correction = np.where(short, x * total, 0.0) / np.where(short, 3 * gravity, 1.0)
        settling = np.where(sticks, total * (1 + correction), 0.0)
        lifts = np.broadcast_to(amplitude > 1, phase.shape)
        status[sticks & ~lifts] = Status.PERMANENT_CONTACT
        rest = lift_off(phase + settling, amplitude)
        duration = np.where(sticks, np.where(lifts, settling + rest.wait, np.inf), 0.0)
        velocity = np.where(sticks, np.where(lifts, 0.0, np.nan), velocity)
        pairs = ((rest.phase, phase), (rest.x, x), (rest.y, y), (rest.flown, flown))
        phase, x, y, flown = (np.where(sticks, a, b) for a, b in pairs)
        return _Rebound(phase, none, velocity, duration, status, x, y, flown, settling)

    def fly(self, rebound: _Rebound) -> tuple[_Impact, np.ndarray]:
        flight = Flight(
            rebound.displacement, rebound.velocity, rebound.x, rebound.y, self.amplitude
        )
        landing = land(flight, np.maximum(rebound.flown, flight.sure()))
        phase, before = reduce_angle(rebound.phase + landing.time), -landing.rate
        impact = _Impact(phase, np.zeros_like(phase), before, -self.at(landing.rate) * before)
        return impact, rebound.duration + landing.time


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
    return _Instants(r, lam), (reduce_angle(phase), np.maximum(relative, 0.0)), shape


def simulate(
    restitution: ArrayLike,
    amplitude: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    impacts: int,
    law: RestitutionLaw | None = None,
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
    law : RestitutionLaw, optional
        Gives r of the impacts after the first, which has ``restitution``.

    Raises
    ------
    ModelError
        If r, Λ or a state is outside its range.

    Examples
    --------
    >>> simulate(0.5, 0.0, 0.0, 4.0, 3).time.tolist()
    [0.0, 8.0, 12.0]
    """
    balls, state, shape = _prepare(restitution, amplitude, phase, velocity)
    balls = balls._replace(law=None if law is None else law.flat(shape))
    return follow(balls, state, None, amplitude, shape, impacts)


def _cycle(restitution, amplitude, phase, velocity) -> Cycle:
    """The next impact, δ′ before it, after an impact (τ, v)."""
    balls, state, shape = _prepare(restitution, amplitude, phase, velocity)
    return next_impact(balls, state, shape)


def impact_cycle(
    restitution: ArrayLike, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike
) -> ImpactCycle:
    """The exact map (Eq. 5): from just after one impact, (τ, v), to just after the next.

    Examples
    --------
    >>> float(impact_cycle(0.5, 0.0, 0.0, 4.0).velocity)
    2.0
    """
    cycle = _cycle(restitution, amplitude, phase, velocity)
    bounced = table(cycle.phase, np.asarray(amplitude))[0]
    bounced = bounced - np.asarray(restitution) * cycle.relative_velocity
    return ImpactCycle(cycle.phase, bounced, cycle.time)


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
    return _cycle(restitution, amplitude, phase, after)
