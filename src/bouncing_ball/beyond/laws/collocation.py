r"""One contact of any law, from its start to its release: Gauss collocation by panels.

A law with the root m is smooth in ``q = p^{1/m}`` and p′. In a new time s the motion is therefore
smooth even at the ends of the contact, where p = 0 ::

    dq/ds = p′,    dp′/ds = F = λ [a - f(p, p′)],    dt/ds = λ = m q^{m-1}

with the load ``a = w - Λ sin(φ + t)``. The contact is divided into panels. In each, the values of
p′ at 12 Gauss nodes (16 if derivatives are computed) are found by Picard's iteration, for many
contacts at the same time; a sweep consists of three products with one small matrix. The length of
the panel that reaches the release is found in the same sweeps, by Newton's method.

Picard's iteration converges in panels of about a radian of the contact's oscillation. For laws with
m = 1, which are nearly linear, the sweeps are therefore those of Newton's method with the slopes
of the force at the start of the panel, unless derivatives are computed. In the eigenvectors of the
integration over the nodes the linearised equations are one division for each. These panels may be
as long as the nodes resolve.

A panel is accepted if the sweeps have converged, if the last Legendre coefficients of the
integrands are small, and if the grip is positive at all nodes; otherwise a shorter panel is tried.
The error at the end of a panel is of the order of the square of these coefficients (Gauss), so
that the errors of D, p and p′ are below 10⁻¹² of their scales. Two limits remain: the grip could
vanish and return between two nodes, which are a small part of an oscillation apart, and the method
cannot prove that a contact never ends.

The derivatives of the end follow from the linearised equations of the collocation: one linear
system for each panel.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.beyond.laws.scales import scales
from bouncing_ball.beyond.laws.slopes import Slopes, slopes_of
from bouncing_ball.paper.contact.damping import Release

if TYPE_CHECKING:
    from bouncing_ball.beyond.laws.contact_law import ContactLaw

# Nodes of a panel without and with derivatives. The Legendre coefficients of the derivatives are
# larger by about the number of nodes, so that more nodes are needed for the same error of the end.
_NODES, _FINER = 12, 16
# The largest number of sweeps; the change of p′ over V at which they stop; and the change at
# which a panel is still accepted, because the next change would be a hundredth of it. The sweeps
# stop when the share _MOST of the panels has converged: the few others are tried again, because
# they would delay all panels. Newton's sweeps in which a panel's end is found are about twice as
# many as those of the other panels, and are waited for. Of a pair of numbers, the first is for
# Picard's sweeps and the second for Newton's.
_SWEEPS, _SETTLED, _ENOUGH = 22, 3e-13, 1e-12
_MOST, _PATIENT = 0.95, (0, 8)
# The remainder of the grip, or of the time, relative to its change over the panel, up to which a
# first-order correction suffices; and the first sweep that computes the end of the panel.
_REACHED, _LOOK = 1e-12, (2, 1)
# Bound of the last Legendre coefficients of the integrands over V or P/V, and the number of these
# coefficients. The panels of Newton's sweeps are limited by this bound, those of Picard's by the
# convergence; with 1e-6 for both, Newton's would miss more short losses of the grip.
_SPECTRUM, _TAIL = (1e-6, 1e-9), 2
# An early sweep, and the change of p′ over V that is wanted there: the actual change determines
# the length of the next panel.
_EARLY, _CHANGE = (5, 2), 1e-3
# Length of the first panel per node, in units of P^{1/m}/V; twice that with Newton's sweeps. The
# duration of a panel over P/V that is allowed for a descending ball even after a shorter panel. The
# longest panel of Newton's sweeps, in radians of the linearised oscillation without damping:
# neighbouring nodes are then at most a fifth of an oscillation apart.
_FIRST, _DOWN, _LONGEST = 0.05, 0.7, 3 * np.pi
# Bounds and safety factor of the ratio of successive lengths; the greatest ratio after a rejected
# panel.
_SHORTER, _LONGER, _SAFETY, _AGAIN = 0.3, (1.3, 2.0), 0.9, 0.6
# Number of contacts computed at the same time, chosen such that their nodes fit into the cache.
_BLOCK = 2048
# Number of bytes that are allocated and freed once. From then on glibc keeps freed memory;
# otherwise it returns the temporary arrays of each sweep to the system, and a third of the time is
# spent on allocating them again.
_KEPT = 1 << 24
# The largest number of panels of one contact: for a dozen oscillations in the computation of
# orbits, and for some hundreds in a simulation.
_PANELS, MOST_PANELS = 120, 2000
# Relative change of p in a panel up to which plain time is used: p = 0 is then more than a panel
# away.
_FAR = 0.7
# The speed over V that is given to a ball at rest on the table, because otherwise q would not
# change.
_AT_REST = 1e-9
# An imaginary step in s, whose square is lost in rounding.
_STEP = 1e-20j
# A time counts as the end of the contact if less than this part of the contact remains.
_END = 1e-12
_Until = np.ndarray | None


class Start(NamedTuple):
    """Starts of contact, one-dimensional arrays.

    The fields are p, p′, the table's phase φ, Λ, and the weight w, which is 1, or 0 for a free
    impact.
    """

    depth: np.ndarray
    rate: np.ndarray
    phase: np.ndarray
    amplitude: np.ndarray
    weight: np.ndarray


class ContactEnds(NamedTuple):
    """The ends of contacts: D, p_e and p′_e, NaN where no end was found.

    ``jacobian`` has the derivatives of (D, p_e, p′_e) with respect to (φ, v, Λ, w), shape
    (..., 3, 4). ``contraction`` is the factor by which the contact multiplies areas of the phase
    plane: exp(-∫ ∂f/∂p′ dt), times a factor for a step of the force at the release. ``integrals``
    has ∫ p dt and ∫ p′ w dt over the contact, with the table's level w = Λ sin(φ + t), shape
    (..., 2); they are NaN unless they are computed.
    """

    duration: np.ndarray
    penetration: np.ndarray
    rate: np.ndarray
    jacobian: np.ndarray
    contraction: np.ndarray
    integrals: np.ndarray


class _Rule(NamedTuple):
    """Gauss nodes in (0, 1), and matrices that act on the values at the nodes.

    ``integral`` gives the integrals from 0 to each node and to 1, ``tail`` the last Legendre
    coefficients, and ``end`` the value at 1.
    """

    node: np.ndarray
    integral: np.ndarray
    tail: np.ndarray
    end: np.ndarray


@lru_cache(maxsize=4)
def _rule(count: int) -> _Rule:
    legendre, degree = np.polynomial.legendre, np.arange(count)
    x, weight = legendre.leggauss(count)
    spectrum = (degree + 0.5)[:, np.newaxis] * legendre.legvander(x, count - 1).T * weight
    sums = legendre.legval(np.append(x, 1.0), legendre.legint(np.eye(count), lbnd=-1)).T
    return _Rule(
        (1 + x[:, np.newaxis]) / 2, sums / 2 @ spectrum, spectrum[-_TAIL:], spectrum.sum(0)
    )


@lru_cache(maxsize=1)
def _modes() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The eigenvalues of the integration from node to node, one of each pair, and two matrices:
    from values at the nodes to coordinates in the eigenvectors, and back to nodes and end.
    """
    rule = _rule(_NODES)
    value, vector = np.linalg.eig(rule.integral[:-1])
    one = value.imag > 0
    back = np.vstack([vector, rule.end @ vector])[:, one]
    return value[one, np.newaxis], np.linalg.inv(vector)[one], 2 * back


def _excess(slopes: Slopes, step, change):
    """The part of the change of p′ in Picard's sweep that Newton's method does not make.

    The linearised equations with constant slopes turn a change c of p′ at the nodes into
    ``(1 + h f_u Q + h² f_p Q²)⁻¹ c``, where hQ is the integration from node to node. The result
    is the difference, at the nodes and at the end.
    """
    value, into, back = _modes()
    ratio = value * (step * slopes.by_rate + value * (step * step * slopes.by_penetration))
    return (back @ (ratio / (1 + ratio) * (into @ change))).real


class _Motion(NamedTuple):
    """Balls in contact: q, p′, t and F, the length of the next panel, and the scales P and V.

    ``side`` is the sign of the law's :meth:`~.ContactLaw.kink` in the state of the ball.
    """

    root: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    push: np.ndarray
    step: np.ndarray
    length: np.ndarray
    speed: np.ndarray
    side: np.ndarray


class _Panel(NamedTuple):
    """A panel of each ball: q, p′ and t at its nodes and its end, and F at the nodes.

    ``final`` is F at the end, ``step`` the length of the panel and ``following`` that of the next;
    ``good`` marks accurate panels, ``last`` those that end the contact, ``surfaced`` those of them
    that end at p = 0 with a positive grip, and ``turned`` those that end at a kink of the law.
    """

    root: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    push: np.ndarray
    final: np.ndarray
    step: np.ndarray
    following: np.ndarray
    good: np.ndarray
    last: np.ndarray
    surfaced: np.ndarray
    turned: np.ndarray


def _some(which: np.ndarray, law: ContactLaw, *rows: Any) -> Any:
    """The laws of some of the contacts, and tuples of arrays whose last axis is the contacts.

    The indices are in ascending order, so that all of them select the rows themselves.
    """
    if which.size == rows[-1][0].shape[-1]:
        return law, *rows
    return law.take(which), *(row._make(x[..., which] for x in row) for row in rows)


def _lever(m: int, root, out=None):
    """λ = dp/dq = m q^{m-1}, by products, which cost less than a power."""
    lever = np.empty_like(root) if out is None else out
    lever[...] = m
    for _ in range(m - 1):
        lever *= root
    return lever


def _load(start: Start, time):
    """a = w - Λ sin(φ + t), by the tangent of the half angle, which costs less than a sine."""
    tangent = start.phase + time
    tangent *= 0.5
    np.tan(tangent, out=tangent)
    square = tangent * tangent
    square += 1
    tangent *= 2 * start.amplitude
    tangent /= square
    return np.subtract(start.weight, tangent, out=tangent)


def _grip(law: ContactLaw, m: int, root, rate, load):
    """The function that vanishes at the release: the grip, or q if the grip is a power of q."""
    if law.release is Release.DISPLACEMENT:
        return root
    grip = law.loaded_grip(root**m, rate, load)
    return grip if law.lag is None else np.where(law.lag == 0, root, grip)


def _ahead(law: ContactLaw, m: int, start: Start, now: _Motion, until, root, rate, time):
    """Functions that are positive up to the end of a panel, one in each row.

    The rows are the grip, or the time that is left; q if the force depends on the load, because
    such a contact may also end at p = 0; and the law's kink function, with its sign at the start.
    """
    if until is None:
        rows = [_grip(law, m, root, rate, _load(start, time) if law.feels_load else None)]
    else:
        rows = [until - time]
    rows += [root] * (law.feels_load and until is None)
    if law.has_kink:
        rows.append(now.side * law.kink(root**m, rate))
    return np.array(rows)


def _left(law: ContactLaw, m: int, start: Start, now: _Motion, until, root, rate, time, final):
    """These functions at the end of a panel, and their derivatives along the motion with respect
    to s.
    """
    state = root + _STEP * rate, rate + _STEP * final, time + _STEP * _lever(m, root)
    found = _ahead(law, m, start, now, until, *state)
    return found.real, found.imag / _STEP.imag


def _summed(begin, step, values, out):
    """The value at the start plus the integral of a rate, up to each node and to the end."""
    np.matmul(_rule(len(values)).integral, values, out=out)
    out *= step
    out += begin
    return out


def _panel(
    law: ContactLaw, start: Start, now: _Motion, until: _Until, count: int = _NODES, m: int = 0
) -> _Panel:
    """The next panel of each ball, which ends at the latest at the release.

    If times ``until`` are given, the panels end there, and releases are not looked for. With m = 1
    the independent variable is plain time; by default m is that of the law.
    """
    (node, integral, tail, end), m = _rule(count), m or law.root
    law = law.continued(now.root**m, now.side) if law.has_kink else law
    force = law.force if m == 1 else law.root_force
    # These arrays are overwritten in each sweep, because allocating them again would take as long
    # as the computation.
    q, t, old, new = (np.empty((count + 1, now.step.size)) for _ in range(4))
    push, inside = np.empty((count, now.step.size)), q[:-1]
    lever = np.ones_like(push)
    new[:-1] = now.rate + node * (now.step * now.push)
    last, more = np.zeros(now.step.size, dtype=bool), np.zeros(now.step.size)
    step = longer = now.step
    reached, first = ~last, np.zeros(last.size, dtype=int)
    # Derivatives need short panels, for which Picard's sweeps suffice.
    newton, row = law.root == 1 and count == _NODES, (law, m, start, now, until)
    if newton:
        # Under any load, because the slopes need not be exact.
        slopes = slopes_of(lambda p, u: law.loaded_force(p, u, start.weight), now.root, now.rate)
    for sweep in range(_SWEEPS):
        old, new = new, old
        rate = old[:-1]
        # If the length of the panel has changed, the nodes have moved.
        moved = longer is not step
        if moved:
            rate += node * ((longer - step) * push)
        step = longer
        _summed(now.root, step, rate, q)
        # In plain time, m = 1, these arrays change only if the nodes have moved.
        if m > 1 or moved or sweep == 0:
            _lever(m, inside, lever)
            _summed(now.time, step, lever, t)
            load = _load(start, t[:-1])
        pushed = law.loaded_force(inside, rate, load) if law.feels_load else force(inside, rate)
        np.subtract(load, pushed, out=push)
        if m > 1:
            push *= lever
        _summed(now.rate, step, push, new)
        if newton:
            new -= _excess(slopes, step, new[:-1] - rate)
            q[-1] = now.root + step * (integral[-1] @ new[:-1])
        if sweep < _LOOK[newton]:
            continue
        if newton and sweep == _LOOK[newton]:
            # Newton's method for the end starts from the first node beyond it; otherwise several
            # sweeps would be spent on halving a long panel.
            ahead = (_ahead(*row, inside, rate, t[:-1]) > 0).all(axis=0)
            longer = step * np.where(ahead, 1.0, node).min(axis=0)
            last = longer < step
            continue
        left, falls = _left(*row, q[-1], new[-1], t[-1], end @ push)
        last |= (left <= 0).any(axis=0)
        if last.any():
            near = np.where(falls < 0, -left / falls, np.where(left > 0, np.inf, -step))
            first = near.argmin(axis=0)
            more, falls = (x[first, np.arange(first.size)] for x in (near, falls))
            unit = np.abs(falls) * step if until is None else 1e-4 * now.length / now.speed
            reached = ~last | (np.abs(more * falls) <= _REACHED * unit)
            more = np.where(last, np.maximum(np.minimum(more, step / 2), -step / 2), 0.0)
            longer = step + more
        if sweep < _EARLY[newton]:
            continue
        rate -= new[:-1]
        change = np.abs(rate, out=rate).max(axis=0) / now.speed
        if sweep == _EARLY[newton]:
            early = change
        most = _MOST if sweep > _PATIENT[newton] else 1.0
        if np.count_nonzero(reached & (change <= _SETTLED)) >= most * change.size:
            break
    rate = new[:-1]
    # The remainder is corrected to first order. At the end of a short panel, or where the grip
    # vanishes slowly, rounding of the load may keep it above its bound.
    time = now.length ** (1 / m) / now.speed
    reached |= np.abs(more) <= _REACHED * (np.maximum(time, t[-1]) if m == 1 else time)
    q[-1] += new[-1] * more
    t[-1] += _lever(m, q[-1]) * more
    final = end @ push
    new[-1] += final * more
    by_rate, by_time = (np.abs(tail @ x).max(axis=0) for x in (push, lever))
    error = np.maximum(by_rate / now.speed, by_time * now.speed / now.length) * step
    full = _load(start, t[:-1]) if law.feels_load else None
    held = ((q[:-1] > 0) & (_grip(law, m, q[:-1], rate, full) > 0)).all(axis=0)
    if law.has_kink:
        # A sign that changes twice within a panel is not seen at its end. A panel up to a given
        # time may be so short that the sign is determined by rounding.
        smooth = (now.side * law.kink(q[:-1] ** m, rate) > 0).all(axis=0)
        held &= smooth if until is None else smooth | last
    turned = last & (first == len(left) - 1) if law.has_kink else np.zeros_like(last)
    surfaced = first == 1 if law.feels_load and until is None else np.zeros_like(last)
    good = reached & held & (change <= _ENOUGH) & (error <= _SPECTRUM[newton])
    slow = (early / _CHANGE) ** (-1 / (2 * _EARLY[newton]))
    slower = np.nan_to_num(np.minimum((error / _SPECTRUM[newton]) ** (-1 / count), slow))
    factor = np.clip(_SAFETY * slower, _SHORTER, _LONGER[newton])
    longest = _LONGEST / np.sqrt(np.abs(slopes.by_penetration)) if newton else np.inf
    factor = np.where(turned & newton, 1.0, np.fmin(factor, longest / step))
    # The length of a panel that ends at a kink is unrelated to that of the next panel.
    taken = np.where(turned, now.step, step)
    following = np.where(good, taken * factor, now.step * np.minimum(factor, _AGAIN))
    ends = last & ~turned, surfaced & ~turned, turned
    # Just below p = 0, at a rounding error, the positive grip would take hold of the ball again.
    q[-1, ends[0] & ends[1]] = 0.0
    return _Panel(q, new, t, push, final, step, following, good, *ends)


def _in_time(law: ContactLaw, start: Start, now: _Motion, until: _Until) -> _Panel:
    """The next panels in plain time, which costs half as much and suffices if q hardly
    changes.
    """
    m, lever = law.root, _lever(law.root, now.root)
    now = now._replace(root=now.root**m, push=now.push / lever, step=now.step * lever)
    panel = _panel(law, start, now, until, m=1)
    root = np.maximum(panel.root, 0.0) ** (1 / m)
    then = _lever(m, root[-1])
    following = panel.following / np.where(panel.good, then, lever)
    return panel._replace(root=root, final=panel.final * then, following=following)


def _next(law: ContactLaw, start: Start, now: _Motion, until: _Until) -> _Panel:
    """The next panels, each in plain time if that suffices and in s otherwise."""
    far = law.root * np.abs(now.rate) * now.step < _FAR * now.root
    sides, panels = [np.flatnonzero(far), np.flatnonzero(~far)], []
    for which, follow in zip(sides, (_in_time, _panel), strict=True):
        if which.size:
            limit = None if until is None else until[which]
            laws, own, then = _some(which, law, start, now)
            panels.append(follow(laws, own, then, limit))
    order = np.argsort(np.concatenate(sides))
    return _Panel(*(np.concatenate(x, axis=-1)[..., order] for x in zip(*panels, strict=True)))


def _longest(m: int, now: _Motion, panel: _Panel) -> np.ndarray:
    """The greatest length of the next panels; time runs faster the deeper a ball is."""
    root, rate = panel.root[-1], panel.rate[-1]
    time = np.maximum(_LONGER[0] * (panel.time[-1] - now.time), _DOWN * now.length / now.speed)
    deeper = (root**m + rate * time) ** (1 / m)
    return np.where(rate > 0, (deeper - root) / rate, np.inf)


def _derivatives(law: ContactLaw, start: Start, panel: _Panel, by: np.ndarray):
    """The derivatives of (q, p′, t) at the ends of panels, and ∫ ∂F/∂p′ ds.

    They are derivatives with respect to (φ, v, Λ, w), and ``by`` are those at the start of the
    panels, shape (..., 3, 4). They solve the linearised equations of the collocation ::

        δF = F_q δq + F_u δp′ + F_t (δφ + δt) + F_Λ δΛ + F_w δw
    """
    count = len(panel.push)
    node, integral, _, _ = _rule(count)
    m, q, rate = law.root, panel.root[:-1].T, panel.rate[:-1].T
    angle = start.phase[:, np.newaxis] + panel.time[:-1].T
    lever, bend = _lever(m, q), m * (m - 1) * q ** max(m - 2, 0)
    state = panel.root[:-1] ** m, panel.rate[:-1]
    load = _load(start, panel.time[:-1]) if law.feels_load else 0.0
    slopes = slopes_of(lambda p, u: law.loaded_force(p, u, load), *state)

    def column(rows):
        return rows[:, :, np.newaxis]

    by_root = column(bend * panel.push.T / lever - lever * lever * slopes.by_penetration.T)
    by_rate = column(-lever * slopes.by_rate.T)
    # The share of the load that the force carries; the force is linear in the load.
    carried = law.loaded_force(*state, 1.0) - law.force(*state) if law.feels_load else np.zeros(1)
    felt = lever * (1 - carried.T)
    by_time = column(-felt * start.amplitude[:, np.newaxis] * np.cos(angle))
    step = panel.step[:, np.newaxis, np.newaxis]
    whole = step * integral
    once, weight = whole[:, :-1], whole[:, -1:]
    # δp′ = δp′₀ + once δF, δq = δq₀ + once δp′, δt = δt₀ + bent δq
    twice, bent = step * (once @ integral[:-1]), once * bend[:, np.newaxis]
    root0, rate0, time0 = (by[:, np.newaxis, k] for k in range(3))
    root = root0 + step * node * rate0
    known = by_root * root + by_rate * rate0 + by_time * (time0 + bent @ root)
    known[:, :, 0] += by_time[:, :, 0]
    known[:, :, 2] -= felt * np.sin(angle)
    known[:, :, 3] += felt
    matrix = np.eye(count) - by_root * twice - by_rate * once - by_time * (bent @ twice)
    pushed = np.linalg.solve(matrix, known)
    root, rate = root + twice @ pushed, rate0 + once @ pushed
    ends = root0 + weight @ rate, rate0 + weight @ pushed, time0 + weight @ (column(bend) * root)
    return np.concatenate(ends, axis=1), (weight @ by_rate)[:, 0, 0]


def _at_release(law: ContactLaw, start: Start, panel: _Panel, by: np.ndarray, strain: np.ndarray):
    """The derivatives of (D, p_e, p′_e) and the contraction, for panels that end at the release."""
    root, rate, final = panel.root[-1], panel.rate[-1], panel.final
    lever, angle = _lever(law.root, root), start.phase + panel.time[-1]
    state = root, rate, _load(start, panel.time[-1])
    by_root, by_rate, by_load = (
        np.imag(_grip(law, law.root, *(x + _STEP * (x is y) for x in state))) / _STEP.imag
        for y in state
    )
    by_root, by_rate = np.where(panel.surfaced, 1.0, by_root), np.where(panel.surfaced, 0, by_rate)
    by_load = np.where(panel.surfaced, 0.0, by_load)
    turning = -start.amplitude * np.cos(angle)
    falls = by_root * rate + by_rate * final + by_load * turning * lever
    # If the force has a step at the release, the rate of change of the grip has a step too.
    force = law.loaded_force(root**law.root, *state[1:])
    step = np.where(by_rate == 0, 0.0, by_rate * lever * force)
    load = turning[:, np.newaxis] * by[:, 2]
    load += np.stack([turning, 0 * angle, -np.sin(angle), np.ones_like(angle)], axis=1)
    by_root, by_rate, by_load, whole, lever, rate, final = (
        x[:, np.newaxis] for x in (by_root, by_rate, by_load, falls, lever, rate, final)
    )
    later = -(by_root * by[:, 0] + by_rate * by[:, 1] + by_load * load) / whole
    ends = by[:, 2] + lever * later, lever * (by[:, 0] + rate * later), by[:, 1] + final * later
    return np.stack(ends, axis=1), np.exp(strain) * falls / (falls + step)


def _integrals(law: ContactLaw, start: Start, panel: _Panel) -> np.ndarray:
    """∫ p dt and ∫ p′ Λ sin(φ + t) dt over panels in s, shape (contacts, 2)."""
    (root, rate, time), weight = (x[:-1] for x in panel[:3]), _rule(len(panel.push)).integral[-1]
    passed = weight[:, np.newaxis] * panel.step * _lever(law.root, root)
    values = root**law.root, rate * (start.weight - _load(start, time))
    return np.stack([(x * passed).sum(axis=0) for x in values], axis=1)


def _begin(law: ContactLaw, start: Start) -> np.ndarray:
    """The rows of :class:`_Motion` at the start of the contacts."""
    scale = scales(law, np.abs(start.rate), start.weight + np.abs(start.amplitude))
    rest = _AT_REST * scale.speed
    rate = np.where((start.depth == 0) & (start.rate < rest), rest, start.rate)
    step = _FIRST * scale.length ** (1 / law.root) / scale.speed
    root = start.depth ** (1 / law.root)
    zero = np.zeros_like(rate)
    side = zero if not law.has_kink else np.where(law.kink(start.depth, rate) < 0, -1.0, 1.0)
    return np.stack([root, rate, zero, zero, step, scale.length, scale.speed, side])


def march(
    law: ContactLaw,
    start: Start,
    panels: int = _PANELS,
    until: np.ndarray | None = None,
    *,
    differentiate: bool = False,
    integrate: bool = False,
) -> ContactEnds:
    """A row of contacts, from states with p ≥ 0 to the release.

    Parameters
    ----------
    law : ContactLaw
        One law, or one for each contact.
    start : Start
        The states. A ball at p = 0 moves down, or is at rest on the table.
    panels : int
        The largest number of panels that are tried for each contact; an oscillation takes about
        eight.
    until : array, optional
        Times after the start at which p and p′ are computed, instead of at the release.
    differentiate : bool
        Whether derivatives are computed, for contacts that start at p = 0; otherwise they are NaN.
    integrate : bool
        Whether the integrals are computed, for a table with gravity (w = 1).

    Examples
    --------
    After a quarter of an oscillation the ball is at the depth v/ϖ:

    >>> from bouncing_ball.beyond.laws.linear import LinearLaw
    >>> zero = np.zeros(1)
    >>> start = Start(zero, np.full(1, np.pi), zero, zero, zero)
    >>> march(LinearLaw(np.pi, 0.0), start, until=np.full(1, 0.5)).penetration.round(12).tolist()
    [1.0]
    """
    np.empty(_KEPT, dtype=np.int8)
    size = start.rate.size
    by, strain = np.zeros((size, 3, 4)), np.zeros(size)
    by[:, 1, 1] = 1.0
    jacobian, contraction = np.full((size, 3, 4), np.nan), np.full(size, np.nan)
    integrals = np.full((size, 2), 0.0 if integrate else np.nan)
    done = np.zeros(size, dtype=bool)
    with np.errstate(all="ignore"):
        active = np.flatnonzero(np.isfinite(start).all(axis=0))
        state = np.full((len(_Motion._fields), size), np.nan)
        state[:, active] = _begin(*_some(active, law, start))
        plain = law.root > 1 and not (differentiate or integrate)
        count = _FINER if differentiate else _NODES
        state[4] *= count * (1 + (law.root == 1 and not differentiate))
        for _ in range(panels if active.size else 0):
            for here in np.array_split(active, -(-active.size // _BLOCK)):
                limit = None if until is None else until[here]
                (laws, own), now = _some(here, law, start), _Motion(*state[:, here])
                row = laws, own, now, limit
                panel = _next(*row) if plain else _panel(*row, count)
                state[4, here] = panel.following
                if law.root > 1:
                    longest = np.where(panel.good, _longest(law.root, now, panel), np.inf)
                    state[4, here] = np.minimum(panel.following, longest)
                good = np.flatnonzero(panel.good)
                here, (laws, own, panel) = here[good], _some(good, laws, own, panel)
                state[:4, here] = panel.root[-1], panel.rate[-1], panel.time[-1], panel.final
                state[-1, here[panel.turned]] *= -1
                done[here] = panel.last
                if integrate:
                    integrals[here] += _integrals(laws, own, panel)
                if differentiate and here.size:
                    by[here], more = _derivatives(laws, own, panel, by[here])
                    strain[here] += more
                    end = np.flatnonzero(panel.last)
                    at, (laws, own, panel) = here[end], _some(end, laws, own, panel)
                    ends = _at_release(laws, own, panel, by[at], strain[at])
                    jacobian[at], contraction[at] = ends
            active = active[~done[active]]
            if not active.size:
                break
    root, rate, time = (np.where(done, x, np.nan) for x in state[:3])
    integrals[~done] = np.nan
    depth = np.maximum(root, 0.0) ** law.root
    if until is None and law.release is Release.DISPLACEMENT:
        depth *= 0
    return ContactEnds(time, depth, rate, jacobian, contraction, integrals)


def states(law: ContactLaw, start: Start, end, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ at times within contacts whose ends (D, p_e, p′_e) are known.

    All arrays have one entry per contact.
    """
    inside = np.flatnonzero((time > 0) & (time < (1 - _END) * end[0]))
    laws, own = _some(inside, law, start)
    found = march(laws, own, MOST_PANELS, time[inside])
    depth = np.where(time > 0, end[1], start.depth)
    rate = np.where(time > 0, end[2], start.rate)
    depth[inside], rate[inside] = found.penetration, found.rate
    return depth, rate


def _row(law: ContactLaw, *columns: ArrayLike):
    """The laws and the columns, broadcast and flattened, and the shape to which they broadcast."""
    columns = (*(np.asarray(x, dtype=float) for x in columns), np.zeros(law.shape))
    arrays = np.broadcast_arrays(*columns)
    shape = arrays[0].shape
    return law.flat(shape), [x.reshape(-1) for x in arrays[:-1]], shape


def contacts(
    law: ContactLaw,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> ContactEnds:
    """Contacts that start at p = 0 with speed v > 0 at a phase φ of the table.

    Parameters
    ----------
    law : ContactLaw
        One law, or one for each contact.
    speed, phase, amplitude : array_like
        v, φ and Λ.
    weight : array_like
        The weight w: 1, or 0 for a free impact.

    Returns
    -------
    ContactEnds
        Arrays of the shape to which the arguments broadcast. They are NaN where v ≤ 0, and where
        the ball is not released within a dozen oscillations.

    Examples
    --------
    A quarter of the energy is left after an impact with r = 1/2:

    >>> from bouncing_ball.beyond.laws.hertzian import Tsuji, tsuji_damping
    >>> free = contacts(Tsuji(100.0, tsuji_damping(0.5)), 3.0, weight=0.0)
    >>> round(float(free.rate), 12)
    -1.5
    """
    laws, (v, *others), shape = _row(law, speed, phase, amplitude, weight)
    start = Start(0 * v, np.where(v > 0, v, np.nan), *others)
    found = march(laws, start, differentiate=True)
    return ContactEnds(*(x.reshape((*shape, *x.shape[1:])) for x in found))


def integrals(
    law: ContactLaw,
    duration: ArrayLike,
    depth: ArrayLike,
    rate: ArrayLike,
    phase: ArrayLike,
    amplitude: ArrayLike,
) -> np.ndarray:
    """∫ p dt and ∫ p′ w dt over contacts that start with p and p′ and last D, with w = Λ sin τ.

    The shape is (2, ...); a contact without a duration has the integrals 0.

    Examples
    --------
    A fast ball hardly feels gravity, so that p = 1000 sin πt, whose integral is 2000/π:

    >>> from bouncing_ball.beyond.laws.linear import LinearLaw
    >>> law = LinearLaw(np.pi, 0.0)
    >>> sunk, moved = integrals(law, 1.0, 0.0, 1000.0 * np.pi, 0.0, 0.0)
    >>> round(float(sunk) / 1000, 3), float(moved)
    (0.637, 0.0)
    """
    columns = duration, depth, rate, phase, amplitude
    laws, (lasts, p, u, angle, lam), shape = _row(law, *columns)
    start = Start(p, np.where(lasts > 0, u, np.nan), angle, lam, np.ones_like(p))
    found = march(laws, start, MOST_PANELS, integrate=True).integrals.T
    return np.where(lasts > 0, found, 0.0).reshape(2, *shape)


def path(
    law: ContactLaw,
    found: ContactEnds,
    time: ArrayLike,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ a time after the start of contacts, with 0 ≤ time ≤ D.

    Parameters
    ----------
    law : ContactLaw
    found : ContactEnds
        The result of :func:`contacts` for these starts.
    time : array_like
        The times; they may have additional leading axes.
    speed, phase, amplitude, weight : array_like
        The starts, as in :func:`contacts`.

    Examples
    --------
    >>> from bouncing_ball.beyond.laws.linear import LinearLaw
    >>> law = LinearLaw(np.pi, 0.0)
    >>> depth, rate = path(law, contacts(law, np.pi, weight=0.0), 0.5, np.pi, weight=0.0)
    >>> round(float(depth), 12), abs(round(float(rate), 12))
    (1.0, 0.0)
    """
    laws, (t, *columns), shape = _row(law, time, *found[:3], speed, phase, amplitude, weight)
    start = Start(np.zeros_like(t), *columns[3:])
    depth, rate = states(laws, start, columns[:3], t)
    return depth.reshape(shape), rate.reshape(shape)
