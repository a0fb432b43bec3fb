"""Events on a branch of n-T orbits on a contact, whatever its law."""

from collections.abc import Callable
from typing import Any

from bouncing_ball.continuation.events import Event
from bouncing_ball.orbits.stability import period_doubling_function, saddle_node_function

# Impact velocity and flight time vanish together where an orbit merges with
# permanent contact. The equations are singular there, and rounding enters
# divided by both: stop where 1e-12 is left.
_MARGIN = 1e-4


def branch_events(orbit: Callable, trace_and_determinant: Callable) -> tuple[Event, ...]:
    """Bifurcations, and the ends of the domain in which an orbit makes sense.

    Parameters
    ----------
    orbit : callable
        The orbit at a point y.
    trace_and_determinant : callable
        Those of the monodromy of an orbit.
    """

    def stability(test: Callable) -> Callable[[Any], Any]:
        return lambda y: test(*trace_and_determinant(orbit(y)))

    return (
        Event("saddle-node", stability(saddle_node_function)),
        Event("period doubling", stability(period_doubling_function)),
        Event(
            "contact lost",
            lambda y: -orbit(y).relative_impact_velocity - _MARGIN,
            terminal=True,
            reason="contact lost: the ball no longer closes in on the table at impact",
        ),
        Event(
            "flight lost",
            lambda y: orbit(y).flight_time - _MARGIN,
            terminal=True,
            reason="flight lost: the contact fills the whole cycle",
        ),
    )
