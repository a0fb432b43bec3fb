"""A bound of the parameter of a branch, for problems whose last unknown is the parameter itself."""

from bouncing_ball_beyond.inherited.numerics.events import Event


def parameter_bound(bound, upper, reason):
    """The terminal event at which the last entry of y reaches a bound."""
    sign = -1.0 if upper else 1.0
    return Event("parameter bound", lambda y: sign * (y[..., -1] - bound), True, reason)
