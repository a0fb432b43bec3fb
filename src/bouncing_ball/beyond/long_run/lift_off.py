r"""From the lift-off to the next sticking: the locked orbits of the restitution model.

After sticking, a ball of the restitution model always leaves in the state of the lift-off. Its
return to the table therefore follows from (Λ, r) alone, and the ball locks if it sticks again. A
contact changes this return by its delay at each impact. To first order, the deviation e from the
restitution model changes from impact j to impact j + 1 by ::

    e ← M_j e + K_j/ϖ

where M_j is the Jacobian of the flight, and K_j/ϖ the difference between the maps of the corrected
and the restitution model. The lift-off itself is the same up to 1/ϖ². The phase at which the
chattering ends before the next sticking is then late by

    S/ϖ,    S = |Σ_j (product of the expansions after j) K_j|

The ball misses the sticking if this delay exceeds the wait w until the table would release the
ball: the locked orbit should be the same for ϖ > S/w.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.beyond.corrected.orbits import CorrectedModel
from bouncing_ball.beyond.simulation import dynamics_of
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.flight import table

# The ϖ of the corrected model from whose map the first order is computed. The relative error from
# the second order is of order 1/ϖ, and that from rounding of order ε ϖ.
_STIFF = 1e6
# The delay of a bounce is neglected if this bounce and all that follow take less time than this
# number times 1 - Λ sin φ, the acceleration that presses the ball on the table.
_CHATTER = 1e-2


class Return(NamedTuple):
    """Returns from the lift-off, arrays of one shape; 0 or NaN for a ball that does not stick.

    ``periods`` and ``impacts`` are the numbers of periods of the table and of impacts until the
    ball sticks. ``sensitivity`` is S, that of the phase at which the chattering ends, and ``wait``
    is the time w from this phase to the next lift-off. An S that is too large for a number is
    infinite.
    """

    periods: np.ndarray
    impacts: np.ndarray
    sensitivity: np.ndarray
    wait: np.ndarray


def returns(restitution: ArrayLike, amplitude: ArrayLike, impacts: int) -> Return:
    """The returns of balls that lift off from a table with Λ > 1, within a number of impacts.

    Examples
    --------
    >>> returns([0.5, 0.6], [2.5, 3.0], 100).periods.tolist()
    [6, 13]
    """
    r, lam = np.broadcast_arrays(*map(np.asarray, (restitution, amplitude)))
    corrected = CorrectedModel.of_contact(
        SpringDamper.from_restitution(r.ravel() * 1.0, _STIFF, Release.DISPLACEMENT)
    )
    # A ball at rest on the table, at a phase at which the table presses on it.
    rest = np.full(r.shape, -np.pi / 2), np.zeros(r.shape)
    dynamics, state, shape = dynamics_of(r, lam).in_a_row(*rest)
    other = dynamics_of(corrected.impact_law, lam.ravel()).in_a_row(*(x.ravel() for x in rest))[0]
    impact, beside = dynamics.start(*state), other.start(*state)
    found = np.zeros((2, r.size), dtype=int), np.full((2, r.size), np.nan)
    ball, time, late = np.arange(r.size), np.zeros(r.size), np.zeros((2, r.size))
    for count in range(impacts):
        departure = dynamics.depart(impact, differentiate=True)
        sticks = departure.sticks if count else np.zeros(ball.size, dtype=bool)
        if sticks.any():
            held = (departure.duration - departure.settling)[sticks]
            turns = np.rint((time + departure.duration)[sticks] / (2 * np.pi))
            found[0][:, ball[sticks]] = turns, np.full(held.size, count)
            found[1][:, ball[sticks]] = (
                np.nan_to_num(np.abs(late[0, sticks]), nan=np.inf, posinf=np.inf),
                held,
            )
            left = np.flatnonzero(~sticks)
            rows = impact, departure, beside, ball, time
            dynamics, impact, departure, beside, ball, time = dynamics.kept(left, *rows)
            other, late = other.take(left), late[:, left]
        if not ball.size:
            break
        after, passed = dynamics.fly(departure)
        moved = other.section(other.fly(other.depart(beside))[0])
        shift = np.array([reduce_angle(moved[0] - after.phase), moved[1] - after.velocity])
        if count:
            gravity = 1 - table(impact.phase, dynamics.amplitude)[1]
            bounces = 2 * departure.flight.velocity / (1 - dynamics.law)
            shift[:, (0 < gravity) & (bounces < _CHATTER * gravity**2)] = 0
            with np.errstate(over="ignore", invalid="ignore"):
                late = np.array(dynamics.jacobian(impact, departure, after, passed).apply(*late))
        late += _STIFF * shift
        time += passed if count else passed - departure.duration
        impact, beside = after, other.at_section(after.phase, after.velocity)
    (periods, number), (sensitivity, wait) = found
    return Return(*(x.reshape(shape) for x in (periods, number, sensitivity, wait)))
