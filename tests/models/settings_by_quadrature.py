"""Balls on any table, with drag or on a spring, followed by a Runge-Kutta method: a second code.

It integrates the equations of motion themselves, in the coordinates in which they are usually
written, and shares nothing with the package.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

# The flight is integrated for this time first, without a search for a landing.
_LEAVING = 1e-4
_LONGEST = 400.0
_EXACT = {"rtol": 1e-13, "atol": 1e-15, "method": "DOP853"}


class World(NamedTuple):
    """The restitution r, the table's height and its two derivatives, and the flight.

    ``rates`` are the derivatives of a state at a time, and ``state`` is the state with δ and δ′ at
    a time; ``gap`` gives these two back.
    """

    restitution: float
    rates: Callable
    state: Callable
    gap: Callable


def table_of(amplitude: float, sine: list[float], cosine: list[float]) -> Callable:
    """The height of the table and its derivatives, by the given harmonics."""

    def at(time: float, order: int = 0) -> float:
        total = 0.0
        for k, (a, b) in enumerate(zip(sine, cosine, strict=True), 1):
            angle = k * time + order * np.pi / 2
            total += k**order * (a * np.sin(angle) + b * np.cos(angle))
        return amplitude * total

    return at


def with_drag(restitution: float, table: Callable, drag: float) -> World:
    """Gravity and a drag, in the coordinates of the room."""
    return World(
        restitution,
        rates=lambda t, y: [y[1], -1 - drag * y[1]],
        state=lambda t, gap, rate: [gap + table(t), rate + table(t, 1)],
        gap=lambda t, y: (y[0] - table(t), y[1] - table(t, 1)),
    )


def on_a_spring(
    restitution: float, table: Callable, frequency: float, damping: float, gap: float
) -> World:
    """The impact oscillator, in the coordinates of its stop."""

    def rates(t, y):
        return [y[1], -2 * damping * frequency * y[1] - frequency**2 * (y[0] - gap) - table(t, 2)]

    return World(
        restitution,
        rates=rates,
        state=lambda t, gap, rate: [gap, rate],
        gap=lambda t, y: (y[0], y[1]),
    )


def impacts(world: World, phase: float, relative: float, count: int) -> np.ndarray:
    """Times and relative velocities of the impacts that follow a first one, shape (2, count)."""

    def lands(t, y):
        return world.gap(t, y)[0]

    lands.terminal = True
    lands.direction = -1
    time = phase
    found = [(0.0, relative)]
    while len(found) < count:
        start = world.state(time, 0.0, -world.restitution * relative)
        first = solve_ivp(world.rates, (time, time + _LEAVING), start, **_EXACT)
        rest = solve_ivp(
            world.rates,
            (time + _LEAVING, time + _LONGEST),
            first.y[:, -1],
            events=lands,
            **_EXACT,
        )
        time = rest.t_events[0][0]
        relative = world.gap(time, rest.y_events[0][0])[1]
        found.append((time - phase, relative))
    return np.array(found).T
