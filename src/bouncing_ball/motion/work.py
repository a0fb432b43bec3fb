"""Integrals of a ball's height and of the power it receives, over contacts and flights.

The work of the table w = Λ sin τ on a ball is, per unit of mass, ::

    ∫ (z″ + 1) w′ dτ = [z′ w′ + w] + ∫ z′ w dτ

because w″ = -w. In a linear contact ϖ² δ = w - 1 - δ″ - l δ′ with l = 2ζϖ. Integration by parts
gives ::

    ϖ² ∫ δ dτ = -[w′ + δ′ + l δ] - D
    (ϖ² - 1) I + l J = [w²/2 - w - δ′ w′ - δ w - l δ w′],                 I = ∫ δ w′ dτ
    (ϖ² - 1) J - l I = Λ² D/2 + [w′ - w w′/2 - δ′ w + δ w′ - l δ w],      J = ∫ δ w dτ

The table does no work in a flight. Over a long time its mean work equals the mean dissipation of
the contacts. At an instantaneous impact the work is the impulse times w′, and while a ball rests on
the table it is the integral of (1 - w) w′.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.collocation import integrals
from bouncing_ball.contacts.elementary import table
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.linear_contact import has_closed_form


def change(values: np.ndarray) -> np.ndarray:
    """The value at the end of a contact minus the value at its start."""
    return values[1] - values[0]


def over_contact(
    law: SpringDamper, amplitude: ArrayLike, duration: Any, level: Any, gap: Any, rate: Any
) -> tuple[np.ndarray, np.ndarray]:
    """The integrals ∫ z dτ and ∫ z′ w dτ over contacts.

    Parameters
    ----------
    law : SpringDamper
    amplitude, duration : array_like
        Λ and the duration D of the contacts.
    level : tuple of array
        w′ and w, each at the start and at the end of the contacts, shape (2, ...).
    gap, rate : array, shape (2, ...)
        δ and δ′ at the start and at the end.

    Examples
    --------
    On a table at rest z = δ, and the table does no work:

    >>> law, still = SpringDamper(2.0, 0.0), np.zeros((2, 1))
    >>> gap, rate = np.array([[0.0], [0.0]]), np.array([[-1.0], [1.0]])
    >>> [float(x[0]) for x in over_contact(law, 0.0, 2.0, (still, still), gap, rate)]
    [-1.0, 0.0]
    """
    (w_rate, w), stiffness = level, law.frequency_ratio**2
    loss = 2 * law.damping_ratio * law.frequency_ratio
    of_rate = change(w * w / 2 - w - rate * w_rate - gap * w - loss * gap * w_rate)
    of_level = change(w_rate - w * w_rate / 2 - rate * w + gap * w_rate - loss * gap * w)
    of_level = of_level + np.square(amplitude) * duration / 2
    s = stiffness - 1
    by_rate = (s * of_rate - loss * of_level) / (s * s + loss * loss)
    sunk = -(change(w_rate + rate + loss * gap) + duration) / stiffness
    return sunk - change(w_rate), change(gap * w + w * w / 2) - by_rate


def over_steps(
    law: Any,
    amplitude: Any,
    duration: Any,
    phase: np.ndarray,
    gap: np.ndarray,
    rate: np.ndarray,
    flown: Any,
) -> tuple[np.ndarray, np.ndarray]:
    """The integral ∫ z dτ and the work of the table, over contacts and the flights after them.

    Parameters
    ----------
    law : ContactLaw or None
        None if impacts are instantaneous; a contact with a duration is then a rest on the table.
    amplitude, duration : array_like
        Λ and the duration D of the contacts.
    phase, gap, rate : array, shape (2, ...)
        φ, δ and δ′ at the start and at the end of the contacts.
    flown : array_like
        The duration of the flights.

    Examples
    --------
    A ball that leaves a table at rest with z′ = 3 flies for 6, and its mean height is 3:

    >>> phase, gap, rate = np.zeros((2, 1)), np.zeros((2, 1)), np.array([[-3.0], [3.0]])
    >>> [float(x[0]) for x in over_steps(None, 0.0, 0.0, phase, gap, rate, 6.0)]
    [18.0, 0.0]
    """
    w_rate, w = table(phase, amplitude)
    if isinstance(law, SpringDamper) and has_closed_form(law):
        held, moved = over_contact(law, amplitude, duration, (w_rate, w), gap, rate)
    else:
        held, moved = -change(w_rate), change(w * w) / 2
        if law is not None:
            held, moved = (held, moved) - integrals(
                law, duration, -gap[0], -rate[0], phase[0], amplitude
            )
    low, velocity = (gap + w)[1], rate + w_rate
    height = held + (low + (velocity[1] / 2 - flown / 6) * flown) * flown
    return height, change(velocity * w_rate + w) + moved
