"""Events on a branch of n-T orbits of any model."""

from collections.abc import Callable

from bouncing_ball.continuation.events import Event
from bouncing_ball.orbits.stability import Bifurcation

# Impact velocity and flight time vanish together where an orbit merges with
# permanent contact. The equations are singular there, and rounding enters
# divided by both: stop where 1e-12 is left.
_MARGIN = 1e-4


def bifurcations(orbit: Callable) -> tuple[Event, ...]:
    """Saddle-node and period doubling of the orbits at points y."""

    def event(kind: Bifurcation) -> Event:
        return Event(kind, lambda y: kind.test(*orbit(y).trace_and_determinant()))

    return tuple(event(kind) for kind in Bifurcation)


def branch_events(orbit: Callable) -> tuple[Event, ...]:
    """Bifurcations, and the ends of the domain in which the orbits at points y make sense."""
    return (
        *bifurcations(orbit),
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
