"""The motion of a ball in a contact of any force law, in a time in which it is analytic.

The penetration p = -δ obeys p″ = a(p, p′, t) with a = 1 - Λ sin(τ + t) - f(p, p′). Forces such as
p^{3/2} are not smooth at p = 0, where a contact begins and ends, but are analytic functions of
the root q = p^{1/m}. In the *root time* s, with dt = λ ds and λ = m q^{m-1},

    dq/ds = v,    dv/ds = λ a,    dt/ds = λ,    v = p′,

and the motion is analytic up to both ends of a contact. It is found on panels, on each of which
v is a polynomial with the values v_j at Gauss nodes. They solve the collocation equations by
repeated integration (Picard's sweeps, of which k leave an error of the order of (ωh)^{2k}/(2k)!)::

    q = q₀ + h ∫ v,    t = t₀ + h ∫ λ,    v = v₀ + h ∫ λ a

If the last Legendre coefficients of v are ε, the end of the panel is right to the order of ε². Where a force has a
kink, a panel ends at the kink.

All is analytic in the state, the length and the parameters, and complex steps pass through it. In
this module a row of contacts is an array of shape (rows,), and node values are (rows, nodes).
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from bouncing_ball_beyond.balls import H

ORDER = 14
"""Gauss nodes of a panel."""

ROUGH = 1e-7
"""The largest last Legendre coefficients of v over its greatest value; its square is a rounding error."""

SMOOTH = 1e-13
"""The same where the coefficients do not fall as those of an analytic function do."""

FALLING = 0.02
"""The last coefficients over those in the middle, at most, of an analytic function; after a jump of
the slope the quotient is (1/2)² to (1/2)³."""

CONVERGED = 1e-14
"""The change of v over its greatest value in the last sweep."""

SWEEPS = 16
"""The largest number of sweeps of a panel: with ωh = 2 the last one changes 2³²/32! = 2e-26."""

MOST_PANELS = 4000
"""The largest number of panels of a contact; one oscillation takes some ten."""

NEAR = 1e-8
"""The last step to an event over the length of its panel; its square is the error."""

NEWTON = 8
"""The largest number of steps to an event."""

TINY = 1e-300

ROWS = 1000
"""So many contacts are followed at a time: their nodes fit into a processor's cache."""


def _gauss(n):
    """Nodes x on [0, 1], weights, integrals from 0 to the nodes, Legendre coefficients from values."""
    x, w = legendre.leggauss(n)
    to_coefficients = np.linalg.inv(legendre.legvander(x, n - 1))
    of_basis = legendre.legval(x, legendre.legint(to_coefficients, lbnd=-1))
    return (x + 1) / 2, w / 2, of_basis / 2, to_coefficients.T


_NODES, _WEIGHTS, _INTEGRALS, _TO_COEFFICIENTS = _gauss(ORDER)
# Of the last two coefficients, and of two in the middle.
_LAST = _TO_COEFFICIENTS[:, [-2, -1, ORDER // 2, ORDER // 2 + 1]]


class Motion(NamedTuple):
    """The equation of motion in contact, and what ends a panel.

    Parameters
    ----------
    root : int
        m: 1, or an even number.
    acceleration : callable
        p″ as a function of (p, v, t, given), which are numbers and arrays that broadcast.
    release : callable
        The release function of (q, v, t, given). It is negative in a contact and zero at its end.
    kinks : tuple of callables
        Functions of (q, v, t, given) whose zeros are kinks or jumps of the acceleration.
    given : mapping
        Numbers, or columns of shape (rows, 1) with a value for each contact.
    """

    root: int
    acceleration: Callable
    release: Callable
    kinks: tuple
    given: Mapping

    def of(self, rows):
        """The motion of some of the contacts."""
        picked = {
            name: value[rows] if np.ndim(value) else value for name, value in self.given.items()
        }
        return self._replace(given=picked)

    def lever(self, q):
        """λ = m q^{m-1}."""
        power = np.ones_like(q)
        for _ in range(self.root - 1):
            power = power * q
        return self.root * power

    def push(self, q, v, t):
        """λ and λ a."""
        lever = self.lever(q)
        return lever, lever * self.acceleration(q * lever / self.root, v, t, self.given)


class Panel(NamedTuple):
    """A solved panel: q, v and t at the nodes and at the end, and how well v has converged."""

    nodes: tuple
    end: tuple
    change: np.ndarray


def solve_panel(motion, start, h, v=None):
    """The motion on panels of the lengths h from the states (q, v, t) at their starts.

    ``v`` are first values at the nodes; by default the speed does not change.
    """
    q0, v0, t0 = start
    v = v0 + 0 * h * _NODES if v is None else v
    for sweep in range(SWEEPS):
        q = q0 + h * (v @ _INTEGRALS)
        lever = motion.lever(q)
        t = t0 + h * (lever @ _INTEGRALS)
        push = lever * motion.acceleration(q * lever / motion.root, v, t, motion.given)
        before, v = v, v0 + h * (push @ _INTEGRALS)
        if sweep >= 3:
            change = _greatest(v - before)
            if np.all(change <= CONVERGED * _greatest(v)):
                break
    sums = (nodes @ _WEIGHTS for nodes in (v, push, lever))
    end = tuple(y + h * total[:, None] for y, total in zip(start, sums, strict=True))
    return Panel((q, v, t), end, change)


def _greatest(x):
    """The greatest absolute value in each row of the real and the imaginary parts, shape (parts, rows)."""
    return np.abs(_parts(x)).max(-1)


def _parts(x):
    return np.stack([x.real, x.imag]) if np.iscomplexobj(x) else x[None]


def _resolved(panel, size):
    """Whether v is right on a panel, and a factor for the length of the next one.

    The Legendre coefficients of an analytic function fall geometrically, those of a function with a
    kink as a power, and then the squared last one is no measure of the error. ``size`` has the
    greatest values of v, shape (parts, rows).
    """
    size = np.maximum(size, _greatest(panel.nodes[1]))
    coefficients = np.abs(_parts(panel.nodes[1]) @ _LAST)
    last, middle = coefficients[..., :2].max(-1), coefficients[..., 2:].max(-1)
    geometric = (last <= ROUGH * size) & (last <= FALLING * middle)
    exact = last <= SMOOTH * size
    settled = panel.change <= 100 * CONVERGED * size
    good = ((geometric | exact) & settled).all(0)
    ratio = (last / np.maximum(size, TINY)).max(0)
    factor = 0.9 * (ROUGH / np.maximum(ratio, TINY)) ** (1 / ORDER)
    factor = np.where(np.isfinite(factor), np.clip(factor, 0.25, 4.0), 0.25)
    return good, np.where(good, factor, np.minimum(factor, 0.5))


def _first_crossing(motion, events, side, start, panel):
    """The first event of each panel, and its place on [0, 1]; infinity if there is none."""
    place, which = np.full(side.shape[1], np.inf), np.zeros(side.shape[1], int)
    x = np.concatenate([[0.0], _NODES, [1.0]])
    columns = zip(start, panel.nodes, panel.end, strict=True)
    states = [np.real(np.concatenate(column, axis=1)) for column in columns]
    for k, event in enumerate(events):
        values = np.real(event(*states, motion.given))
        unknown = side[k] == 0
        side[k, unknown] = np.sign(values[unknown, 1])
        over = values * side[k][:, None] < 0
        over[:, 0] = False
        after = np.argmax(over, axis=1)[:, None]
        low, high = (np.take_along_axis(values, i, 1) for i in (after - 1, after))
        part = np.abs(low) / np.maximum(np.abs(low) + np.abs(high), TINY)
        here = np.where(over.any(1), (x[after - 1] + part * (x[after] - x[after - 1]))[:, 0], np.inf)
        earlier = here < place
        place, which = np.where(earlier, here, place), np.where(earlier, k, which)
    return place, which


def _distance(motion, events, which, state):
    """The root time from a state to the zero of its event, by one step of Newton's method, and q′, v′, t′."""
    lever, push = motion.push(*state)
    rates = state[1], push, lever
    beside = [np.real(y) + 1j * H * np.real(rate) for y, rate in zip(state, rates, strict=True)]
    real = {name: np.real(value) for name, value in motion.given.items()}
    distance = 0 * state[0]
    for k, event in enumerate(events):
        slope = np.imag(event(*beside, real)) / H
        distance = np.where(
            (which == k)[:, None], -event(*state, motion.given) / slope, distance
        )
    return distance, rates


def _panel_to_event(motion, events, which, start, h):
    """Panels that end at their events, from a first length, their lengths, and whether it was found."""
    v = None
    for _ in range(NEWTON):
        panel = solve_panel(motion, start, h, v)
        more, rates = _distance(motion, events, which, panel.end)
        away = np.abs(np.real(more)) / h
        if np.all(away <= NEAR):
            break
        v, h = panel.nodes[1], np.clip(h + np.real(more), 0.5 * h, 1.5 * h)
    end = tuple(y + more * rate for y, rate in zip(panel.end, rates, strict=True))
    return panel._replace(end=end), h + more, (away <= 100 * NEAR)[:, 0]


def _next_panel(motion, events, side, start, h, size):
    """Panels of at most the lengths h, which end at the first event.

    Returns the panels, their lengths, the events at their ends (-1 if there is none), whether they are
    right, and factors for the next lengths.
    """
    panel = solve_panel(motion, start, h)
    place, which = _first_crossing(motion, events, side, start, panel)
    found = np.ones(which.size, bool)
    here = np.flatnonzero(np.isfinite(place))
    which = np.where(np.isfinite(place), which, -1)
    if here.size:
        begin, length = [y[here] for y in start], np.real(h[here]) * place[here, None]
        part, more, found[here] = _panel_to_event(
            motion.of(here), events, which[here], begin, length
        )
        for whole, new in zip((*panel.nodes, *panel.end), (*part.nodes, *part.end), strict=True):
            whole[here] = new
        panel.change[:, here] = part.change
        h = h + 0 * more[:1]
        h[here] = more
    good, factor = _resolved(panel, size)
    return panel, h, which, good & found, np.where(found, factor, 0.5)


@np.errstate(all="ignore")
def follow(motion, q, v, h, until=None):
    """Contacts from their starts to their first releases, or to a root time.

    Parameters
    ----------
    motion : Motion
        The equation of motion.
    q, v, h : array, shape (rows, 1)
        q and v at the start, and the length of the first panel, which is shortened where necessary.
    until : array, shape (rows, 1), optional
        Root times at which contacts are left.

    Returns
    -------
    s, q, v, t : array, shape (4, rows, 1)
        Root time, q, v and time after the start; NaN for contacts that are not released.
    """
    events = motion.kinks if until is not None else (*motion.kinks, motion.release)
    now = np.array([0 * v, q + 0 * v, v, 0 * v])
    ends = np.full_like(now, np.nan)
    side = np.zeros((len(events), v.shape[0]))
    side[len(motion.kinks) :] = -1.0
    h, size = np.real(h).copy(), _greatest(v)
    active = np.flatnonzero(np.isfinite(v[:, 0]))
    for _ in range(MOST_PANELS):
        over = [np.zeros(0, int)]
        for here in np.array_split(active, -(-active.size // ROWS)) if active.size else ():
            s, *start = now[:, here]
            length, last = h[here], np.zeros(here.size, bool)
            if until is not None:
                left = until[here] - s
                pieces = np.ceil(np.real(left) / length - 1e-9)
                length, last = left / pieces, pieces[:, 0] <= 1
            sides = side[:, here]
            panel, length, which, good, factor = _next_panel(
                motion.of(here), events, sides, start, length, size[:, here]
            )
            side[:, here] = sides
            h[here] = np.where(which[:, None] < 0, np.real(length), h[here]) * factor[:, None]
            kept = here[good]
            now[:, kept] = np.array([s + length, *panel.end])[:, good]
            size[:, kept] = np.maximum(size[:, kept], _greatest(panel.nodes[1])[:, good])
            turned = good & (which >= 0)
            side[which[turned], here[turned]] *= -1
            released = turned & (which == len(motion.kinks)) | good & last & (which < 0)
            over.append(here[released])
        over = np.concatenate(over)
        ends[:, over] = now[:, over]
        active = np.setdiff1d(active, over)
        if not active.size:
            break
    return ends
