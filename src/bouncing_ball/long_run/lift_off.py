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

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.corrected.model import CorrectedModel
from bouncing_ball.models.damping import Release
from bouncing_ball.models.dynamics import Departure, Dynamics, Impact
from bouncing_ball.models.flight import table
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.numerics.elementary import reduce_angle

# The ϖ of the corrected model from whose map the first order is computed. The relative error from
# the second order is of order 1/ϖ, and that from rounding of order ε ϖ.
_STIFF = 1e6
# The delay of a bounce is neglected if this bounce and all that follow take less time than this
# number times 1 - Λ sin φ, the acceleration that presses the ball on the table.
_CHATTER = 1e-2


class Return(NamedTuple):
    """Returns from the lift-off, arrays of one shape; 0 or NaN for a ball that does not stick.

    ``periods`` and ``impacts`` are the numbers of periods of the table and of impacts until the
    ball sticks. ``sensitivity`` is S, that of the phase at which the chattering ends, ``peak`` is
    P, the largest one of a phase of impact on the way, and ``wait`` is the time w from the end of
    the chattering to the next lift-off. An S or P that is too large for a number is infinite. Where
    S exceeds w by more than the digits of a double, rounding errors decide on the period.
    """

    periods: np.ndarray
    impacts: np.ndarray
    sensitivity: np.ndarray
    peak: np.ndarray
    wait: np.ndarray

    def scale(self) -> np.ndarray:
        """max(S/w, P): the scale of the ϖ from which on a contact has the same locked orbit."""
        return np.maximum(self.sensitivity / self.wait, self.peak)


class _Balls(NamedTuple):
    """Balls on their way from the lift-off to the next sticking, and the deviations e times ϖ."""

    lane: np.ndarray
    # The time since the lift-off.
    time: np.ndarray
    # Shape (2, balls): the deviation of φ and that of δ′.
    deviation: np.ndarray
    # The largest deviation of φ so far.
    peak: np.ndarray
    impact: Impact
    # The same states in the corrected model.
    corrected_impact: Impact

    def take(self, which: np.ndarray) -> Self:
        """The balls with these indices."""
        return self._replace(
            lane=self.lane[which],
            time=self.time[which],
            deviation=self.deviation[:, which],
            peak=self.peak[which],
            impact=pick(self.impact, which),
            corrected_impact=pick(self.corrected_impact, which),
        )


def _store(
    found: Return, balls: _Balls, departure: Departure, sticks: np.ndarray, impacts: int
) -> None:
    """Store the returns of the balls that stick after this number of impacts."""
    lane = balls.lane[sticks]
    time = (balls.time + departure.duration)[sticks]
    late = np.abs(balls.deviation[0, sticks])
    found.periods[lane] = np.rint(time / (2 * np.pi))
    found.impacts[lane] = impacts
    found.sensitivity[lane] = np.nan_to_num(late, nan=np.inf, posinf=np.inf)
    found.peak[lane] = balls.peak[sticks]
    found.wait[lane] = (departure.duration - departure.settling)[sticks]


def _next_impacts(
    dynamics: Dynamics, corrected: Dynamics, balls: _Balls, departure: Departure, *, lifts_off: bool
) -> _Balls:
    """The balls at their next impacts, with e ← M e + K/ϖ.

    The lift-off is the same in both models, so that the time and e begin there.
    """
    impact = balls.impact
    after, passed = dynamics.fly(departure)
    corrected_after, _ = corrected.fly(corrected.depart(balls.corrected_impact))
    phase, velocity = corrected.section(corrected_after)
    shift = np.array([reduce_angle(phase - after.phase), velocity - after.velocity])
    deviation = balls.deviation
    if lifts_off:
        passed = passed - departure.duration
    else:
        gravity = 1 - table(impact.phase, dynamics.amplitude)[1]
        chattering_time = 2 * departure.flight.velocity / (1 - dynamics.law)
        shift[:, (0 < gravity) & (chattering_time < _CHATTER * gravity**2)] = 0
        with np.errstate(over="ignore", invalid="ignore"):
            change = dynamics.jacobian(impact, departure, after, passed)
            deviation = np.array(change.apply(*deviation))
    deviation = deviation + _STIFF * shift
    size = np.nan_to_num(np.abs(deviation[0]), nan=np.inf, posinf=np.inf)
    return balls._replace(
        time=balls.time + passed,
        deviation=deviation,
        peak=np.maximum(balls.peak, size),
        impact=after,
        corrected_impact=corrected.at_section(after.phase, after.velocity),
    )


def returns(restitution: ArrayLike, amplitude: ArrayLike, impacts: int) -> Return:
    """The returns of balls that lift off from a table with Λ > 1, within a number of impacts.

    Examples
    --------
    >>> returns([0.5, 0.6], [2.5, 3.0], 100).periods.tolist()
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

    found = Return(
        periods=np.zeros(r.size, dtype=int),
        impacts=np.zeros(r.size, dtype=int),
        sensitivity=np.full(r.size, np.nan),
        peak=np.full(r.size, np.nan),
        wait=np.full(r.size, np.nan),
    )
    balls = _Balls(
        lane=np.arange(r.size),
        time=np.zeros(r.size),
        deviation=np.zeros((2, r.size)),
        peak=np.zeros(r.size),
        impact=dynamics.start(*state),
        corrected_impact=corrected.start(*state),
    )
    for count in range(impacts):
        departure = dynamics.depart(balls.impact, differentiate=True)
        if count:
            sticks = departure.sticks
            if sticks.any():
                _store(found, balls, departure, sticks, count)
                left = np.flatnonzero(~sticks)
                dynamics, departure = dynamics.kept(left, departure)
                corrected = corrected.take(left)
                balls = balls.take(left)
        if not balls.lane.size:
            break
        balls = _next_impacts(dynamics, corrected, balls, departure, lifts_off=count == 0)
    return Return(*(x.reshape(shape) for x in found))
