r"""From the lift-off to the next sticking: the locked orbits of the restitution model.

After sticking, a ball of the restitution model always leaves in the state of the lift-off. Its
return to the table therefore follows from (Λ, r) alone, and the ball locks if it sticks again. A
contact changes this return by its delay at each impact. To first order, the deviation e from the
restitution model changes from impact j to impact j + 1 by ::

    e ← M_j e + K_j/ϖ

where M_j is the Jacobian of the flight, and K_j/ϖ the difference between the maps of the corrected
and the restitution model. The flight after the lift-off is the same up to 1/ϖ², although with the
displacement release it begins later by 2ζ/ϖ. The phase at which the chattering ends before the next
sticking is then late by

    S/ϖ,    S = |Σ_j (product of the expansions after j) K_j|

The ball misses the sticking if this delay exceeds the wait w until the table would release the
ball. The first order also fails if the deviation becomes large on the way, although it may contract
before the ball sticks: at some impact the phase is early or late by P/ϖ,

    P = max_j |e_j|,    e_j the deviation of the phase of impact j, times ϖ

and if this is not small against one radian, the ball may meet the table in another flight. The
scale of the ϖ from which on the locked orbit is the same is therefore max(S/w, P). It is no
threshold: the constant before P is of order one and differs from orbit to orbit.
"""

from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.long_run.recurrence import periods_in
from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.damping import Release
from bouncing_ball.models.dynamics import Departure, Dynamics, Impact, Leg
from bouncing_ball.models.flight import table
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.numerics.elementary import reduce_angle

# The ϖ of the corrected model from whose map the first order is computed. The relative error from
# the second order is of order 1/ϖ, and that from rounding of order ε ϖ.
_STIFF = 1e6
# The delay of a bounce is neglected if this bounce and all that follow take less time than this
# number times 1 - Λ sin φ, the acceleration that presses the ball on the table.
_CHATTER = 1e-2


class Lap(NamedTuple):
    """Ways from the lift-off to the next sticking; 0 or NaN for a ball that does not stick again.

    All arrays have one shape. ``periods`` and ``impacts`` are the numbers of periods of the table
    and of impacts until the ball sticks. ``sensitivity`` is S, that of the phase at which the
    chattering ends, ``peak`` is P, the largest one of a phase of impact on the way, and ``wait`` is
    the time w from the end of the chattering to the next lift-off. An S or P that is too large for
    a number is infinite. Where S exceeds w by more than the digits of a double, rounding errors
    decide on the period.
    """

    periods: np.ndarray
    impacts: np.ndarray
    sensitivity: np.ndarray
    peak: np.ndarray
    wait: np.ndarray

    def scale(self) -> np.ndarray:
        """max(S/w, P): the scale of the ϖ from which on a contact has the same locked orbit."""
        return np.maximum(self.sensitivity / self.wait, self.peak)


class _OnLap(NamedTuple):
    """Balls on their way from the lift-off to the next sticking."""

    lane: np.ndarray
    # The time since the lift-off.
    time: np.ndarray
    # The deviation e times ϖ: that of φ, and that of δ′.
    phase_shift: np.ndarray
    velocity_shift: np.ndarray
    # The largest deviation of φ so far.
    peak: np.ndarray
    # The states of the present impacts in the corrected model.
    corrected_impact: Impact


def _store(
    found: Lap, balls: _OnLap, departure: Departure, sticks: np.ndarray, impacts: int
) -> None:
    """Store the laps of the balls that stick after this number of impacts."""
    lane = balls.lane[sticks]
    time = (balls.time + departure.duration)[sticks]
    late = np.abs(balls.phase_shift[sticks])
    found.periods[lane] = periods_in(time)
    found.impacts[lane] = impacts
    found.sensitivity[lane] = np.nan_to_num(late, nan=np.inf, posinf=np.inf)
    found.peak[lane] = balls.peak[sticks]
    found.wait[lane] = (departure.duration - departure.settling)[sticks]


def _at_next_impacts(leg: Leg, corrected: Dynamics, balls: _OnLap, *, lifts_off: bool) -> _OnLap:
    """The balls at their next impacts, with e ← M e + K/ϖ.

    The lift-off is the same in both models, so that the time and e begin there.
    """
    departure = leg.departure
    after, passed = leg.fly()
    corrected_after, _ = next(corrected.legs(balls.corrected_impact)).fly()
    phase, velocity = corrected.section(corrected_after)
    shift = np.array([reduce_angle(phase - after.phase), velocity - after.velocity])
    deviation = np.array([balls.phase_shift, balls.velocity_shift])
    if lifts_off:
        passed = passed - departure.duration
    else:
        gravity = 1 - table(leg.impact.phase, leg.dynamics.amplitude)[1]
        chattering_time = 2 * departure.flight.velocity / (1 - leg.dynamics.law)
        shift[:, (0 < gravity) & (chattering_time < _CHATTER * gravity**2)] = 0
        with np.errstate(over="ignore", invalid="ignore"):
            deviation = np.array(leg.jacobian().apply(*deviation))
    phase_shift, velocity_shift = deviation + _STIFF * shift
    size = np.nan_to_num(np.abs(phase_shift), nan=np.inf, posinf=np.inf)
    return _OnLap(
        lane=balls.lane,
        time=balls.time + passed,
        phase_shift=phase_shift,
        velocity_shift=velocity_shift,
        peak=np.maximum(balls.peak, size),
        corrected_impact=corrected.at_section(after.phase, after.velocity),
    )


def laps(restitution: ArrayLike, amplitude: ArrayLike, impacts: int) -> Lap:
    """The laps of balls that lift off from a table with Λ > 1, within a number of impacts.

    Examples
    --------
    >>> laps([0.5, 0.6], [2.5, 3.0], 100).periods.tolist()
    [6, 13]
    """
    r, lam = np.broadcast_arrays(
        np.asarray(restitution, dtype=float), np.asarray(amplitude, dtype=float)
    )
    # A ball at rest on the table, at a phase at which the table presses on it.
    phase = np.full(r.shape, -np.pi / 2)
    velocity = np.zeros(r.shape)
    dynamics, state, shape = RestitutionModel(r).dynamics(lam).in_a_row(phase, velocity)
    contact = SpringDamper.from_restitution(r.ravel(), _STIFF, Release.DISPLACEMENT)
    corrected_model = CorrectedModel.of_contact(contact)
    corrected, _, _ = corrected_model.dynamics(lam.ravel()).in_a_row(*state)

    found = Lap(
        periods=np.zeros(r.size, dtype=int),
        impacts=np.zeros(r.size, dtype=int),
        sensitivity=np.full(r.size, np.nan),
        peak=np.full(r.size, np.nan),
        wait=np.full(r.size, np.nan),
    )
    balls = _OnLap(
        lane=np.arange(r.size),
        time=np.zeros(r.size),
        phase_shift=np.zeros(r.size),
        velocity_shift=np.zeros(r.size),
        peak=np.zeros(r.size),
        corrected_impact=corrected.start(*state),
    )
    legs = dynamics.legs(dynamics.start(*state), differentiate=True)
    for count, leg in enumerate(islice(legs, impacts)):
        sticks = leg.departure.sticks
        if count and sticks.any():
            _store(found, balls, leg.departure, sticks, count)
            left = np.flatnonzero(~sticks)
            corrected = corrected.take(left)
            (balls,) = leg.keep(left, balls)
            if not left.size:
                break
        balls = _at_next_impacts(leg, corrected, balls, lifts_off=count == 0)
    return Lap(*(x.reshape(shape) for x in found))
