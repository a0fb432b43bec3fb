"""The kinds of motion on which balls end, as datasets, figures and texts name them."""

from enum import StrEnum


class Kind(StrEnum):
    """The kind of motion on which a ball ends."""

    ORBIT = "orbit"
    """The motion repeats after n periods of the table and k impacts, where n and k have no common
    divisor: an n-T orbit with k impacts, without sticking."""
    SUBHARMONIC = "subharmonic"
    """The motion repeats only after m n periods and m k impacts, m > 1, without sticking: for
    example m = 2 beyond the period doubling of an n-T orbit."""
    LOCKED = "locked"
    """The motion repeats, and the ball sticks to the table in each repetition: after an instant it
    rests on the table until the lift-off, or a contact lasts longer than one of its damped
    oscillations. The period is 0 if the ball sticks again and again, but after a number of impacts
    that rounding errors decide."""
    PERMANENT_CONTACT = "permanent contact"
    CHAOTIC = "chaotic"
    """The motion is not known to repeat as long as it was followed, and neighbouring motions
    separate from it at an exponential rate. If it is followed for longer, it may turn out to be a
    long transient. After instantaneous impacts it has stuck once at most, because a ball that
    sticks twice repeats its motion. On a contact of finite stiffness it may have stuck many times:
    deviations shrink there by a finite factor, and may grow by a larger one until the ball sticks
    again."""
    UNDECIDED = "undecided"
