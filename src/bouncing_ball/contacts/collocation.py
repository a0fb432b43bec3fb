r"""One contact of any law under load, by collocation with spectral accuracy.

The unknowns are the acceleration at the nodes of :mod:`bouncing_ball.contacts.quadrature`,
as ``B = D p″``, the duration D, and the end of the contact, p′_e and e = p_e/D ::

    B = D [1 - Λ sin(φ + D S) - f(p, p′)]
    p′_e = v + gain B,    e = v + lift B,    grip(D e, p′_e) = 0

They are solved for by Newton's method with the exact Jacobian, for many contacts at
once; the matrix of the last step also gives the derivatives of the end in the start.

The nodes are doubled until a contact has converged: Newton's steps have fallen to
rounding, the last Legendre coefficients of B are below 10⁻⁷ of the largest, and
doubling has moved the end by less than 10⁻⁴. D and p′_e are then right to better
than 10⁻¹², as their error falls twice as fast as the coefficients. What does not
converge with the most nodes is NaN: no contact.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.first_guess import Guess, Start, first_guess
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.quadrature import Scheme, node_of, scheme, share, share_rate

# Numbers of nodes, and contacts at a time: their matrices fit into the cache.
_LEVELS = (20, 40, 80, 160)
_BLOCK = 64
# Newton steps on each level; the first only has to come near, from a guess.
_ITERATIONS = 12
_NEAR, _THERE = 1e-6, 1e-11
# Last Legendre coefficients over the largest, and how far doubling may move the end.
_SPECTRUM, _MOVED = 1e-7, 1e-4
_TAIL = 3
_TINY = 1e-300


class Contacts(NamedTuple):
    """Contacts, in a row. NaN where none was found.

    ``jacobian`` has the derivatives of the end (D, p_e, p′_e) in the start (φ, v), Λ and
    the weight, shape (..., 3, 4). ``contraction`` is by what the contact multiplies areas
    of the phase plane, exp(-∫ ∂f/∂p′ dt), and the step of the force at the release.
    ``spectrum`` has the Legendre coefficients of B.
    """

    duration: np.ndarray
    penetration: np.ndarray
    rate: np.ndarray
    jacobian: np.ndarray
    contraction: np.ndarray
    spectrum: np.ndarray


class _State(NamedTuple):
    """Unknowns at a level, and the motion p = D h, p′ = u that they stand for."""

    push: np.ndarray
    duration: np.ndarray
    end_rate: np.ndarray
    end_depth: np.ndarray
    u: np.ndarray
    h: np.ndarray


def _state(s: Scheme, start: Start, z: np.ndarray) -> _State:
    n = len(s.node)
    push, (duration, rate, depth) = z[:, :n], (z[:, n + k, np.newaxis] for k in range(3))
    v = start.speed[:, np.newaxis]
    u = np.where(s.early, v, rate) + push @ s.rate.T
    h = np.where(s.early, v * s.share, depth - rate * s.rest) + push @ s.path.T
    return _State(push, duration, rate, depth, u, h)


def _equations(s: Scheme, law: ContactLaw, start: Start, z: np.ndarray):
    """Residual (…, n + 3), its Jacobian, and minus its derivatives in φ, v, Λ and weight."""
    n, state = len(s.node), _state(s, start, z)
    duration, row, column = state.duration, law.columns(), start.columns()
    # An iterate may go below the table's level; a solution does not.
    p = np.maximum(duration * state.h, _TINY)
    by_p, by_u = row.slopes(p, state.u)
    angle = column.phase + duration * s.share
    sine, cosine = np.sin(angle), column.amplitude * np.cos(angle)
    total = column.weight - column.amplitude * sine - row.force(p, state.u)
    end, rate = state.duration[:, 0] * state.end_depth[:, 0], state.end_rate[:, 0]
    by_end = law.grip_slopes(end, rate)

    residual = np.empty_like(z)
    residual[:, :n] = state.push - duration * total
    residual[:, n] = rate - start.speed - state.push @ s.gain
    residual[:, n + 1] = z[:, n + 2] - start.speed - state.push @ s.lift
    residual[:, n + 2] = law.grip(end, rate) / z[:, n]

    jacobian = np.zeros((len(z), n + 3, n + 3))
    inner = jacobian[:, :n, :n]
    np.multiply((duration * duration * by_p)[:, :, np.newaxis], s.path, out=inner)
    inner += (duration * by_u)[:, :, np.newaxis] * s.rate
    inner[:, np.arange(n), np.arange(n)] += 1
    late = ~s.early
    deep = duration * by_p
    jacobian[:, :n, n] = deep * state.h - total + duration * cosine * s.share
    jacobian[:, :n, n + 1] = late * duration * (by_u - deep * s.rest)
    jacobian[:, :n, n + 2] = late * duration * deep
    jacobian[:, n, :n], jacobian[:, n, n + 1] = -s.gain, 1
    jacobian[:, n + 1, :n], jacobian[:, n + 1, n + 2] = -s.lift, 1
    jacobian[:, n + 2, n] = (by_end.by_penetration * z[:, n + 2] - residual[:, n + 2]) / z[:, n]
    jacobian[:, n + 2, n + 1] = by_end.by_rate / z[:, n]
    jacobian[:, n + 2, n + 2] = by_end.by_penetration

    right = np.zeros((len(z), n + 3, 5))
    right[:, :, 0] = residual
    right[:, :n, 1] = -duration * cosine
    right[:, :n, 2] = -(s.early * duration) * (deep * s.share + by_u)
    right[:, n : n + 2, 2] = 1
    right[:, :n, 3] = -duration * sine
    right[:, :n, 4] = duration
    return jacobian, right


def _newton(s: Scheme, law: ContactLaw, start: Start, z: np.ndarray, enough: float):
    """Solutions, derivatives of the unknowns, and which have converged."""
    n = len(s.node)
    slopes = np.full((*z.shape, 4), np.nan)
    done = np.zeros(len(z), dtype=bool)
    active = np.arange(len(z))
    for _ in range(_ITERATIONS):
        matrix, right = _equations(s, law.take(active), start.take(active), z[active])
        solvable = np.all(np.isfinite(right), axis=(1, 2)) & np.all(
            np.isfinite(matrix), axis=(1, 2)
        )
        matrix[~solvable] = np.eye(n + 3)
        try:
            found = np.linalg.solve(matrix, right)
        except np.linalg.LinAlgError:
            break
        step = np.where(solvable[:, np.newaxis], found[:, :, 0], np.nan)
        # A contact may get shorter or longer by half of itself at once.
        size = np.abs(step[:, n]) / z[active, n]
        step *= np.minimum(1.0, 0.5 / np.maximum(size, _TINY))[:, np.newaxis]
        z[active] -= step
        slopes[active] = found[:, :, 1:]
        speed = np.abs(start.speed[active]) + np.abs(z[active, n + 1])
        size = np.maximum(size, np.abs(step[:, n + 1]) / speed)
        done[active] = size <= enough
        active = active[(size > enough) & np.isfinite(size)]
        if not active.size:
            break
    return z, slopes, done


def _from_guess(s: Scheme, start: Start, guess: Guess) -> np.ndarray:
    """Unknowns on a level, from the accelerations of a rough path."""
    duration = guess.duration[:, np.newaxis]
    time = duration * s.share
    passed = np.sum(guess.time[:, :, np.newaxis] <= time, axis=0)
    before = np.clip(passed - 1, 0, len(guess.time) - 2)

    def at(table, index):
        return np.take_along_axis(table, index.T, axis=0).T

    left, width = at(guess.time, before), at(guess.time, before + 1) - at(guess.time, before)
    part = np.clip(np.where(width > 0, (time - left) / np.where(width > 0, width, 1), 0), 0, 2)
    first, second = at(guess.acceleration, before), at(guess.acceleration, before + 1)
    push = duration * (first + part * (second - first))
    return _unknowns(s, start, push, guess.duration)


def _unknowns(s: Scheme, start: Start, push, duration) -> np.ndarray:
    ends = duration, start.speed + push @ s.gain, start.speed + push @ s.lift
    return np.concatenate([push, np.stack(ends, axis=1)], axis=1)


def _refined(old: Scheme, new: Scheme, z: np.ndarray) -> np.ndarray:
    """Unknowns on a finer level, the polynomial interpolated."""
    n = len(old.node)
    values = np.polynomial.legendre.legvander(2 * new.node - 1, n - 1)
    push = z[:, :n] @ old.spectrum.T @ values.T
    return np.concatenate([push, z[:, n:]], axis=1)


def _solve(law: ContactLaw, start: Start) -> Contacts:
    """The contacts of one block."""
    size = len(start.speed)
    out = np.full((size, 4), np.nan)
    jacobian = np.full((size, 3, 4), np.nan)
    spectrum = np.zeros((size, _LEVELS[-1]))
    guess = first_guess(law, start)
    left = np.flatnonzero(np.isfinite(guess.duration))
    old = scheme(_LEVELS[0], law.root)
    part = Guess(guess.time[:, left], guess.acceleration[:, left], guess.duration[left])
    z = _from_guess(old, start.take(left), part)
    z, _, _ = _newton(old, law.take(left), start.take(left), z, _NEAR)
    for count in _LEVELS[1:]:
        if not left.size:
            break
        new, before = scheme(count, law.root), z[:, -3:].copy()
        z = _refined(old, new, z)
        z, slopes, done = _newton(new, law.take(left), start.take(left), z, _THERE)
        legendre = z[:, :count] @ new.spectrum.T
        heights = np.abs(legendre)
        tail = np.max(heights[:, -_TAIL:], axis=1) <= _SPECTRUM * np.max(heights, axis=1)
        duration, rate, depth = z[:, -3], z[:, -2], z[:, -1]
        moved = np.abs(before[:, :2] / z[:, -3:-1] - 1).max(axis=1) <= _MOVED
        held, contraction = _checked(new, law.take(left), start.take(left), z)
        good = done & tail & moved & (duration > 0) & (rate <= 0) & held
        here = left[good]
        out[here] = np.stack([duration, duration * depth, rate, contraction], axis=1)[good]
        d_duration, d_rate, d_depth = (slopes[good, count + k] for k in range(3))
        d_end = d_duration * depth[good, np.newaxis] + d_depth * duration[good, np.newaxis]
        jacobian[here] = np.stack([d_duration, d_end, d_rate], axis=1)
        spectrum[here, :count] = legendre[good]
        again = ~good & np.all(np.isfinite(z), axis=1)
        left, z, old = left[again], z[again], new
    duration, depth, rate, contraction = out.T
    return Contacts(duration, depth, rate, jacobian, contraction, spectrum)


def _checked(s: Scheme, law: ContactLaw, start: Start, z: np.ndarray):
    """Whether the ball is in the table, and held, at all nodes; and the contraction."""
    state, row = _state(s, start, z), law.columns()
    p = state.duration * state.h
    held = np.all((p > 0) & (row.grip(p, state.u) > 0), axis=1)
    damping = row.slopes(np.maximum(p, _TINY), state.u).by_rate * state.duration
    shrunk = np.exp(-(damping @ s.gain))
    # The grip vanishes at another rate where the force makes a step there.
    depth, rate = z[:, -3] * z[:, -1], z[:, -2]
    load, by_end = start.load(z[:, -3]), law.grip_slopes(depth, rate)
    free = by_end.by_penetration * rate + by_end.by_rate * load
    step = by_end.by_rate * law.force(np.maximum(depth, _TINY), rate)
    return held, shrunk * np.where(step == 0, 1.0, free / (free - step))


def contacts(
    law: ContactLaw,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> Contacts:
    """Contacts that start at p = 0 with speed v > 0 at a phase φ of the table.

    Parameters
    ----------
    law : ContactLaw
        One law, or one for each contact.
    speed, phase, amplitude : array_like
        v, φ and Λ.
    weight : array_like
        1, or 0 for a free impact.

    Returns
    -------
    Contacts
        With the broadcast shape of the arguments. NaN where v ≤ 0, where the ball is
        not released within a dozen oscillations, and where nothing has converged.

    Examples
    --------
    A quarter of the energy is left after an impact with r = 1/2:

    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
    >>> free = contacts(Tsuji(100.0, tsuji_damping(0.5)), 3.0, weight=0.0)
    >>> round(float(free.rate), 12)
    -1.5
    """
    arrays = np.broadcast_arrays(
        *(np.asarray(x, dtype=float) for x in (speed, phase, amplitude, weight)),
        np.zeros(law.shape),
    )[:4]
    shape = arrays[0].shape
    start, laws = Start(*(x.reshape(-1) for x in arrays)), law.flat(shape)
    size = start.speed.size
    out = np.full((size, 4), np.nan)
    jacobian, spectrum = np.full((size, 3, 4), np.nan), np.zeros((size, _LEVELS[-1]))
    possible = np.flatnonzero((start.speed > 0) & np.all(np.isfinite(start), axis=0))
    with np.errstate(all="ignore"):
        for first in range(0, possible.size, _BLOCK):
            which = possible[first : first + _BLOCK]
            found = _solve(laws.take(which), start.take(which))
            out[which] = np.stack([*found[:3], found.contraction], axis=1)
            jacobian[which], spectrum[which] = found.jacobian, found.spectrum
    duration, depth, rate, contraction = (x.reshape(shape) for x in out.T)
    jacobian = jacobian.reshape(*shape, 3, 4)
    return Contacts(
        duration, depth, rate, jacobian, contraction, spectrum.reshape(*shape, _LEVELS[-1])
    )


def path(law: ContactLaw, found: Contacts, speed: ArrayLike, time: ArrayLike):
    """p and p′ a time after the start of contacts, with 0 ≤ time ≤ D.

    Parameters
    ----------
    law : ContactLaw
    found : Contacts
        What :func:`contacts` returned for these speeds.
    speed, time : array_like
        v, and the time, whose shape may have more axes in front.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.linear import Linear
    >>> law = Linear(np.pi, 0.0)
    >>> depth, rate = path(law, contacts(law, np.pi, weight=0.0), np.pi, 0.5)
    >>> round(float(depth), 13), abs(round(float(rate), 12))
    (1.0, 0.0)
    """
    time, speed, duration = np.broadcast_arrays(
        np.asarray(time, dtype=float), np.asarray(speed, dtype=float), found.duration
    )
    used = np.flatnonzero(np.any(found.spectrum.reshape(-1, _LEVELS[-1]) != 0, axis=0))
    count = int(used[-1]) + 1 if used.size else 1
    coefficients = np.moveaxis(found.spectrum[..., :count], -1, 0)[..., np.newaxis]
    x = node_of(np.clip(time / duration, 0.0, 1.0), law.root)[..., np.newaxis]
    points, weights = np.polynomial.legendre.leggauss(count // 2 + 2 * law.root)
    inner = x * (points + 1) / 2
    push = np.polynomial.legendre.legval(2 * inner - 1, coefficients, tensor=False)
    push = push * (x * weights / 2) * share_rate(inner, law.root)
    here = share(x, law.root)
    rate = speed + np.sum(push, axis=-1)
    depth = speed * here[..., 0] + np.sum(push * (here - share(inner, law.root)), axis=-1)
    return duration * depth, rate
