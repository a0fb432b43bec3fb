r"""A rough path of a contact: Runge-Kutta steps that the ends of the contact do not disturb.

With ``p = q^m`` and ``dt = m q^{m-1} ds`` the motion of a law with m roots is ::

    dq/ds = p′,    dp′/ds = m q^{m-1} (a - f),    dt/ds = m q^{m-1}

whose right sides are smooth at q = 0, where the law itself is not.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball.contacts.contact_scales import scales
from bouncing_ball.contacts.laws.contact_law import ContactLaw

# Step in parts of P/V, and how many are taken at most: a dozen oscillations.
_STEP = 0.2
_MOST = 400


class Start(NamedTuple):
    """Starts of contact, one-dimensional: v = p′, the table's phase φ, Λ, and the
    ball's weight (1, or 0 for a free impact)."""

    speed: np.ndarray
    phase: np.ndarray
    amplitude: np.ndarray
    weight: np.ndarray

    def load(self, time: np.ndarray) -> np.ndarray:
        """a = 1 - Λ sin(φ + t)."""
        return self.weight - self.amplitude * np.sin(self.phase + time)

    def take(self, which) -> "Start":
        """Some of the contacts."""
        return Start(*(x[which] for x in self))

    def columns(self) -> "Start":
        """Each for a row of times."""
        return Start(*(x[:, np.newaxis] for x in self))


class Guess(NamedTuple):
    """Times and accelerations along the path, shape (steps, contacts), and the duration;
    NaN where the ball is not released."""

    time: np.ndarray
    acceleration: np.ndarray
    duration: np.ndarray


def _rates(law: ContactLaw, start: Start, state: np.ndarray) -> np.ndarray:
    root, rate, time = state
    q = np.maximum(root, 0.0)
    lever = law.root * q ** (law.root - 1)
    push = start.load(time) - law.force(q**law.root, rate)
    # No force yet, whatever the law makes of p = 0.
    push = np.where(q > 0, push, start.load(time))
    return np.stack([rate, lever * push, lever])


def first_guess(law: ContactLaw, start: Start) -> Guess:
    """A path of each contact, right to a few per mil.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.linear import Linear
    >>> one = np.ones(1)
    >>> guess = first_guess(Linear(np.pi, 0.0), Start(one, 0 * one, 0 * one, 0 * one))
    >>> guess.duration.round(2).tolist()
    [1.0]
    """
    scale = scales(law, start.speed, start.weight + np.abs(start.amplitude))
    h = _STEP * scale.length ** (1 / law.root) / scale.speed
    state = np.stack([np.zeros_like(start.speed), start.speed, np.zeros_like(start.speed)])
    duration = np.full_like(start.speed, np.nan)
    times, pushes = [], []
    for step in range(_MOST):
        q, rate, time = state
        p = q**law.root
        push = start.load(time) - (law.force(p, rate) if step else 0.0)
        times.append(time)
        pushes.append(push)
        k1 = _rates(law, start, state)
        k2 = _rates(law, start, state + h / 2 * k1)
        k3 = _rates(law, start, state + h / 2 * k2)
        after = state + h / 6 * (k1 + 2 * (k2 + k3) + _rates(law, start, state + h * k3))
        p_after = np.maximum(after[0], 0.0) ** law.root
        ends = np.isnan(duration) & ((after[0] <= 0) | (law.grip(p_after, after[1]) <= 0))
        if step and np.any(ends):
            slopes = law.grip_slopes(p, rate)
            falls = slopes.by_penetration * rate + slopes.by_rate * push
            ahead = np.where(falls < 0, -law.grip(p, rate) / np.minimum(falls, -1e-300), 0.0)
            duration = np.where(ends, time + ahead, duration)
            if not np.any(np.isnan(duration)):
                break
        # What has ended stays where it is.
        state = np.where(np.isnan(duration), after, state)
    return Guess(np.array(times), np.array(pushes), duration)
