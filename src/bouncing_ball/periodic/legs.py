"""One leg of a periodic orbit: a contact, and the flight after it that lands near a given time.

The landing is the one near the next state of the orbit, and not the first one, so that the leg
depends smoothly on its start also where the flight grazes the table.
"""

from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.models.deviations import Jacobian
from bouncing_ball.models.dynamics import Departure, Dynamics, Impact
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.numerics.first_zero import Zero

# Rounds that find the time from a landing to the section, and the change relative to the time of a
# leg at which they end; each round doubles the number of digits.
_ROUNDS = 6
_SETTLED = 1e-15


class Legs(NamedTuple):
    """The legs of orbits, arrays of shape (..., k).

    ``residual`` are the two sides of Eq. 2 of :mod:`bouncing_ball.periodic.problem`, shape
    (..., k, 2), and ``duration`` the durations of the contacts. ``tangent`` is DP, and
    ``contraction`` the factor by which the contacts multiply areas. ``longer`` are the derivatives
    of the durations by θ and v, shape (..., k, 2), if the durations are unknowns. ``near`` is the
    same matrix as ``tangent`` as if the contact began at the phase θ_{i+1}, and ``velocity`` and
    ``acceleration`` are y′ and δ″ there, with y = δ, or δ + κ δ′ where a contact resumes.
    ``dynamics``, ``impact``, ``departure`` and ``passed``, the time of the leg, are flat.
    """

    residual: np.ndarray
    duration: np.ndarray
    tangent: Jacobian
    near: Jacobian
    contraction: np.ndarray
    longer: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    dynamics: Any
    impact: Any
    departure: Any
    passed: np.ndarray


def no_legs(shape: tuple[int, ...]) -> Legs:
    """Legs of which nothing is known, where no ball is inside the ranges of the parameters."""
    none = np.full(shape, np.nan)
    return Legs(
        residual=np.full((*shape, 2), np.nan),
        duration=none,
        tangent=Jacobian(none, none, none, none),
        near=Jacobian(none, none, none, none),
        contraction=none,
        longer=np.full((*shape, 2), np.nan),
        velocity=none,
        acceleration=none,
        dynamics=None,
        impact=None,
        departure=None,
        passed=none.ravel(),
    )


class Landing(NamedTuple):
    """Landings of flights near given times.

    ``after`` are the impacts, ``passed`` the times from impact to impact, and ``late`` those by
    which the impacts are late on the section. ``near`` and ``passed_near`` are the impacts as if
    the contacts began at the given times, and their times.
    """

    after: Impact
    passed: np.ndarray
    late: np.ndarray
    near: Impact
    passed_near: np.ndarray


def landed(
    dynamics: Dynamics,
    impact: Impact,
    departure: Departure,
    duration: np.ndarray,
    interval: np.ndarray,
    lag: np.ndarray,
) -> Landing:
    """The landings, where δ + κ δ′ = 0 with κ = ``lag``, near the time ``interval`` after the first
    impacts.

    In the corrected model the section is some time after the landing, which is found in a few
    rounds; in other models the first round is enough.
    """
    before = time_to_section(dynamics, impact)
    none = np.zeros(interval.shape, dtype=bool)
    to_section = np.zeros_like(interval)
    for _ in range(_ROUNDS):
        time = interval - duration - to_section
        gap, rate, acceleration, _ = departure.flight.gap(time)
        # One step of Newton's method. If the ball lands slowly, it may be far too long, and yet it
        # is the one with which the height is exactly δ′ t.
        later = -(gap + lag * rate) / (rate + lag * acceleration)
        landing = Zero(time + later, -(rate + later * acceleration), none, none)
        arrived, passed = dynamics.arrive(departure, landing)
        after = without_force(arrived, lag)
        whole = passed + time_to_section(dynamics, after) - before
        last = to_section
        to_section = whole - duration - landing.time
        if not np.any(np.abs(to_section - last) > _SETTLED * interval):
            break
    there, passed_near = dynamics.arrive(departure, Zero(time, -rate, none, none))
    return Landing(after, passed, whole - interval, without_force(there, lag), passed_near)


def lag_of(dynamics: Dynamics, resumes: np.ndarray) -> np.ndarray:
    """κ of the contacts that resume below the level of the table, and 0 for others."""
    if dynamics.contact is None or not resumes.any():
        return np.zeros(resumes.shape)
    return np.where(resumes, dynamics.contact.lag, 0.0)


def without_force(impact: Impact, lag: np.ndarray) -> Impact:
    """The impacts at δ = -κ δ′, where the force of the contact is zero; at δ = 0 for κ = 0."""
    if not lag.any():
        return impact
    return impact._replace(displacement=-lag * impact.velocity)


def time_to_section(dynamics: Dynamics, impact: Impact) -> np.ndarray:
    """The time from the start of the contact to the section, as an angle."""
    phase, _ = dynamics.section(impact)
    return reduce_angle(phase - impact.phase)
