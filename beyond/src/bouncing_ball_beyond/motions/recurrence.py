"""The return of balls to a mark, an impact with which their later states are compared.

The state of a ball is compared with its state at a mark, which is moved forward from time to time
(Brent's method), and the derivative M of the motion F since the mark is stored. The fixed point of
F near the state s of the mark is

    s* = s + (I - M)⁻¹ (F(s) - s).

At the first impact at which s* is nearer to s than a small distance, and at which the multipliers
of M are smaller than 1 by a margin, the mark is moved to this impact. The motion repeats if the
ball then returns to the mark again in as many impacts or fewer. The small distance is far above
rounding errors and far below the distance of two orbits whose multipliers have that margin, so that
neither affects the result.
"""

from typing import NamedTuple, Self

import numpy as np

from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.contacts_and_flights import Impact
from bouncing_ball_beyond.models.deviations import Jacobian
from bouncing_ball_beyond.motions.lyapunov import FORGOTTEN, NEAR

# Distance from the orbit within which a ball on its second turn is regarded as being on the orbit,
# as NEAR is on the first turn: an angle, and a velocity over 1 + Λ. The error of the multipliers is
# then this distance times the curvature of the map.
_NEAR_AGAIN = 1e-6
# The margin by which the multipliers of an attracting motion must be smaller than 1.
_MARGIN = 1e-3
# Returns farther away than this are ignored.
_SIGHT = np.array(1e-2)
# A mark is moved forward after this fraction of all impacts so far, and at least this number.
_SHARE = 0.5
_LEAST = 8


class Mark(NamedTuple):
    """The impact with which the state of each ball is compared, and the motion since then."""

    impact: np.ndarray
    time: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray
    # The derivative of the motion since the mark, and the number of stickings since the mark.
    since: Jacobian
    stuck: np.ndarray
    # The impact at which the mark is moved forward, and the number of impacts until a first return,
    # 0 if there was none.
    until: np.ndarray
    turn: np.ndarray

    @classmethod
    def at(cls, impact: Impact) -> Self:
        """Marks at the first impacts of balls."""
        balls = impact.phase.size
        return cls(
            impact=np.zeros(balls, dtype=int),
            time=np.zeros(balls),
            phase=impact.phase.copy(),
            velocity=impact.velocity.copy(),
            since=Jacobian.identity(balls),
            stuck=np.zeros(balls, dtype=int),
            until=np.full(balls, _LEAST),
            turn=np.zeros(balls, dtype=int),
        )

    def advance(self, change: Jacobian) -> None:
        """Multiply the derivatives by that of the motion to the next impact."""
        for values, new in zip(self.since, change.after(self.since), strict=True):
            values[:] = new

    def near(
        self, phase: np.ndarray, velocity: np.ndarray, amplitude: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The indices of the balls near their marks, and the shifts of their states from these.

        The shifts are an angle, and a velocity over 1 + Λ.
        """
        phase_shift = reduce_angle(phase - self.phase)
        (near,) = (np.abs(phase_shift) < _SIGHT).nonzero()
        if not near.size:
            return near, phase_shift[near], phase_shift[near]
        velocity_shift = (velocity[near] - self.velocity[near]) / (1 + amplitude[near])
        close = np.abs(velocity_shift) < _SIGHT
        near = near[close]
        return near, phase_shift[near], velocity_shift[close]

    def move(
        self,
        here: np.ndarray,
        seen: np.ndarray,
        time: np.ndarray,
        phase: np.ndarray,
        velocity: np.ndarray,
    ) -> None:
        """Move the marks of some balls to their present impacts; after a first return the mark
        stays for one more turn.

        ``here`` are the indices of the balls. The number of impacts seen, the time and the state
        are given for all balls.
        """
        count = seen[here]
        # If the ball did not return for the second time, its first return no longer counts.
        turn = np.where(self.until[here] > count, self.turn[here], 0)
        stay = np.where(turn, turn + 1, np.maximum(_LEAST, (_SHARE * count).astype(int)))
        self.impact[here] = count
        self.time[here] = time[here]
        self.phase[here] = phase[here]
        self.velocity[here] = velocity[here]
        for values, value in zip(self.since, Jacobian.identity(here.size), strict=True):
            values[here] = value
        self.stuck[here] = 0
        self.until[here] = count + stay
        self.turn[here] = turn


class Returns(NamedTuple):
    """Returns to the marks of some balls, arrays with an entry for each of them.

    ``first`` and ``second`` mark the balls that return for the first time, and for the second time
    in as many impacts or fewer; ``marginal`` those that return, and whose largest multiplier is 1
    up to the margin. ``length`` and ``periods`` are the numbers of impacts and of table periods
    since the mark, and ``radius`` the modulus of the largest multiplier.
    """

    first: np.ndarray
    second: np.ndarray
    marginal: np.ndarray
    length: np.ndarray
    periods: np.ndarray
    radius: np.ndarray


def returns_to_marks(
    mark: Mark,
    near: np.ndarray,
    shifts: tuple[np.ndarray, np.ndarray],
    seen: np.ndarray,
    time: np.ndarray,
    amplitude: np.ndarray,
    worst: np.ndarray,
) -> Returns:
    """The returns of balls that are near their marks.

    ``near`` are the indices of these balls, and ``shifts`` the results of :meth:`Mark.near`. The
    number of impacts ``seen``, the ``time``, Λ and the logarithm ``worst`` of the largest growth of
    a deviation since the mark are given for all balls.
    """
    phase_shift, velocity_shift = shifts
    scale = 1 + amplitude[near]
    since = pick(mark.since, near)
    radius = since.spectral_radius()
    length = seen[near] - mark.impact[near]
    periods = periods_in(time[near] - mark.time[near])

    step_phase, step_velocity = since.to_fixed_point(phase_shift, velocity_shift * scale)
    from_orbit = np.maximum(np.abs(step_phase), np.abs(step_velocity) / scale)
    returned_before = mark.turn[near] > 0
    on_orbit = from_orbit <= np.where(returned_before, _NEAR_AGAIN, NEAR)
    attracting = radius <= 1 - _MARGIN
    resolved = worst[near] <= FORGOTTEN
    back = on_orbit & attracting & (periods > 0) & resolved

    from_mark = np.maximum(np.abs(phase_shift), np.abs(velocity_shift))
    marginal = (from_mark < _NEAR_AGAIN) & (np.abs(radius - 1) < _MARGIN)
    return Returns(
        first=back & ~returned_before,
        second=back & returned_before,
        marginal=marginal,
        length=length,
        periods=periods,
        radius=radius,
    )


def periods_in(time: np.ndarray) -> np.ndarray:
    """The nearest numbers of table periods."""
    return np.rint(time / (2 * np.pi)).astype(int)
