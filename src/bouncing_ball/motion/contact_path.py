"""Where balls are during contacts of any law, from the starts of these contacts.

A contact that starts at the table's level is that of the collocation. One that resumes
below it, or that is longer than the collocation solves for, is integrated.
"""

import numpy as np

from bouncing_ball.contacts.collocation import Contacts, contacts, path
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.motion.law_motion import Touch, state_at

# Of the duration: another contact than the simulated one is not used.
_SAME = 1e-9
# The very end, where the ball is not held any more, is taken as this part earlier.
_INSIDE = 1e-11


def contact_path(
    law: ContactLaw, touch: Touch, duration: np.ndarray, which: np.ndarray, time: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ at times after the starts ``which`` of one ball's contacts in a row.

    Examples
    --------
    Half an oscillation of an elastic contact, at its greatest depth v/ϖ:

    >>> from bouncing_ball.contacts.laws.linear import Linear
    >>> one, zero = np.ones(1), np.zeros(1)
    >>> touch, duration = Touch(zero, 1000.0 * one, zero, 0.0), 1e-3 * np.pi * one
    >>> depth, _ = contact_path(Linear(1e3, 0.0), touch, duration, np.array([0]), duration / 2)
    >>> depth.round(5).tolist()
    [1.0]
    """
    found = contacts(law, touch.rate, touch.phase, touch.amplitude)
    level = (touch.depth == 0) & (np.abs(found.duration / duration - 1) <= _SAME)
    depth, rate = np.full((2, time.size), np.nan)
    here = np.flatnonzero(level[which])
    if here.size:
        row = which[here]
        some = Contacts(*(x[row] for x in found))
        depth[here], rate[here] = path(law, some, touch.rate[row], time[here])
    other = np.flatnonzero(~level[which])
    if other.size:
        row = which[other]
        inside = np.minimum(time[other], duration[row] * (1 - _INSIDE))
        depth[other], rate[other] = state_at(law, touch.take(row), inside)
    return depth, rate
