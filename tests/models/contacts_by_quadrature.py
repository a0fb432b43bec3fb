"""Contacts and flights by scipy's integrator, with events: a second code for balls on contacts.

The state is δ and δ′. Nothing is shared with the package but the numbers.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

_EXACT = {"rtol": 1e-13, "atol": 1e-15, "method": "DOP853"}
_LONGEST = 400.0
# After this time, over the first step of the table, an event that is at the start has passed.
_LEAVING = 1e-5


class Scene(NamedTuple):
    """δ″ in flight and in contact at (t, δ, δ′), and the grip, whose downward zero is the
    release.
    """

    free: Callable
    held: Callable
    grip: Callable


def linear(table: Callable, frequency: float, damping: float, lag: float, flight: tuple) -> Scene:
    """A spring and a damper beside the drag or the spring of a flight.

    ``flight`` is ("drag", c) or ("spring", ν, ζ, σ).
    """

    def free(t: float, gap: float, rate: float) -> float:
        if flight[0] == "drag":
            return -1 - flight[1] * (rate + table(t, 1)) - table(t, 2)
        nu, zeta, rest = flight[1:]
        return -2 * zeta * nu * rate - nu**2 * (gap - rest) - table(t, 2)

    def held(t: float, gap: float, rate: float) -> float:
        return free(t, gap, rate) - frequency**2 * gap - 2 * damping * frequency * rate

    return Scene(free, held, lambda gap, rate: -(gap + lag * rate))


def of_force(table: Callable, force: Callable, grip: Callable) -> Scene:
    """A contact with the force f(p, p′) over the weight, and a grip of (p, p′)."""

    def free(t: float, gap: float, rate: float) -> float:
        return -1 - table(t, 2)

    def held(t: float, gap: float, rate: float) -> float:
        return free(t, gap, rate) + force(max(-gap, 0.0), -rate)

    return Scene(free, held, lambda gap, rate: grip(-gap, -rate))


def _until(rates: Callable, time: float, state: np.ndarray, event: Callable) -> tuple:
    def wrapped(t, y):
        return event(y[0], y[1])

    wrapped.terminal = True
    wrapped.direction = -1

    def moved(t, y):
        return [y[1], rates(t, y[0], y[1])]

    begun = solve_ivp(moved, (time, time + _LEAVING), state, **_EXACT)
    rest = solve_ivp(
        moved,
        (time + _LEAVING, time + _LONGEST),
        begun.y[:, -1],
        events=wrapped,
        max_step=0.05,
        **_EXACT,
    )
    return rest.t_events[0][0], rest.y_events[0][0]


def leg(scene: Scene, phase: float, gap: float, rate: float) -> tuple[float, ...]:
    """D, and the time, δ and δ′ of the next start of contact after one at this state.

    A flight below the level of the table ends where the grip returns.
    """
    time, state = _until(scene.held, phase, np.array([gap, rate]), scene.grip)
    duration = time - phase
    if state[0] < -1e-12:

        def ends(gap, rate):
            # The first of: the ball comes above the table, or the grip returns.
            return min(-gap, -scene.grip(gap, rate))

        time, state = _until(scene.free, time, state, ends)
        if state[0] < -1e-9:
            return duration, time - phase, *state
    time, state = _until(scene.free, time, state, lambda gap, rate: gap)
    return duration, time - phase, *state
