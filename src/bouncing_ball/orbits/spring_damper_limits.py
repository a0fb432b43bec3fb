"""Saddle-node, period doubling and orbits at a given Λ, on the explicit branch.

Scalar root finding along the branch of :mod:`bouncing_ball.orbits.spring_damper_branch`,
for arrays of contacts at once: a scan brackets the first root next to the
fold, Chandrupatla's method (:func:`scipy.optimize.elementwise.find_root`)
closes the bracket to the last digit.

The branch comes from Λ → ∞ at short contacts, where Λ falls with the contact
duration until the saddle-node: that is the side which is stable next to the
fold. Entries for which the quantity does not exist are NaN.
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.ensembles import blocks
from bouncing_ball.orbits.orbit import check_index
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.stability import Side, period_doubling_function, saddle_node_function

# Points of the scan on each side of ε = 0, spaced geometrically from a small
# part of 1/ϖ, the scale of the fold, to the ends of the admissible range.
_SCAN = 60
_SCAN_START = 1e-3
# The scan's ends: contacts of a thousandth of the free one, at which Λ exceeds
# 10⁶, and contacts that fill the cycle but for a millionth.
_SHORTEST = 1e-3
_FULL = 1e-6
# Contacts searched at once: as many as keep a scan in some ten megabytes.
_BLOCK = 1024
# Width, in parts of its ε and of 1/ϖ, in which the zero of dΛ/dε is looked for next
# to that of the multiplier: wide against the rounding of the trace (some 1e-9 of
# these for ϖ = 10⁸), narrow against the distance to the next turn of Λ.
_NEXT_TO = 1e-4


def _columns(contact: SpringDamper, n: ArrayLike, *more: ArrayLike):
    check_index(n)
    arrays = (contact.frequency_ratio, contact.damping_ratio, n, *more)
    return np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in arrays))


def _range(contact: SpringDamper, n: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """ε at short contacts, where Λ is beyond any use, and at D → 2πn."""
    start = contact.free_angle
    full = contact.damped_frequency * 2 * np.pi * np.asarray(n)
    low = -start * (1 - _SHORTEST)
    high = full * (1 - _FULL) - start
    return np.minimum(low, high), high


def _scan(low, high, scale):
    """Grid from low to high, geometric on both sides of 0, shape (points, ...)."""
    small = np.minimum(_SCAN_START * scale, -low / 2)
    steps = np.linspace(0, 1, _SCAN).reshape(-1, *(1,) * np.ndim(low))
    down = -small * (-low / small) ** steps[::-1]
    up = small * np.maximum(high / small, 1.0) ** steps
    grid = np.concatenate([down, np.zeros((1, *np.shape(low))), up])
    # A contact softer than the cycle is long ends before ε = 0.
    return np.minimum(grid, high)


def _bracket(values, *, last=False):
    """Index of the first, or last, sign change along the first axis, and whether
    there is one. Not-a-number has no sign."""
    left, right = values[:-1], values[1:]
    change = ((left < 0) & (right >= 0)) | ((left >= 0) & (right < 0))
    found = np.any(change, axis=0)
    at = np.argmax(change[::-1] if last else change, axis=0)
    return (len(change) - 1 - at if last else at), found


def _at(grid, index):
    return np.take_along_axis(grid, index[np.newaxis], axis=0)[0]


def _close(function, left, right, found, args):
    """Roots in brackets, NaN where there is none."""
    # Imported here: it takes a third of a second, and not every run asks for limits.
    from scipy.optimize.elementwise import find_root

    result = np.full(np.shape(found), np.nan)
    if np.any(found):
        chosen = tuple(x[found] for x in args)
        # The default tolerance is four units in the last place of the root.
        result[found] = find_root(function, (left[found], right[found]), args=chosen).x
    return result


def _by_blocks(search, release, *columns):
    """A search for many contacts, few at a time: the scan of each has 121 points."""
    flat = [np.ravel(column) for column in columns]
    found = np.empty(flat[0].size)
    for part in blocks(found.size, _BLOCK):
        found[part] = search(release, *(column[part] for column in flat))
    return found.reshape(columns[0].shape)


def _fold_function(release):
    def fold(excess, omega, zeta, n):
        return branch_point(excess, SpringDamper(omega, zeta, release), n).fold

    return fold


def _floquet_function(release, test):
    """A test function of stability along the branch, of arrays."""

    def floquet(excess, omega, zeta, n):
        point = branch_point(excess, SpringDamper(omega, zeta, release), n)
        return test(point.trace, point.determinant)

    return floquet


def _zero(test, grid, values, args, *, last=False):
    """First, or last, zero of a test function along a grid; NaN where there is none.

    A test function would change sign at a pole as well. Closed upon, its value
    is then larger than at both ends of the bracket, and at a zero smaller: no
    tolerance decides that it is one.
    """
    index, found = _bracket(values, last=last)
    root = _close(test, _at(grid, index), _at(grid, index + 1), found, args)
    size = np.abs(values)
    smallest = np.minimum(_at(size, index), _at(size, index + 1))
    return np.where(np.abs(test(root, *args)) <= smallest, root, np.nan)


def saddle_node(contact: SpringDamper, n: ArrayLike) -> np.ndarray:
    """Excess angle ε of the saddle-node, the first zero of 1 - tr + det.

    dΛ/dε vanishes there too, and with more digits for a stiff contact: next to
    the zero of the one, that of the other is taken. It vanishes as well where
    the ball grazes, and changes sign at the poles of the branch, where Λ is
    infinite; neither is a bifurcation.

    Returns
    -------
    numpy.ndarray
        To be given to :func:`~bouncing_ball.orbits.spring_damper_branch.branch_point`.
        NaN where the branch has no fold.

    Examples
    --------
    >>> contact = SpringDamper(1e4, 0.05)
    >>> bool(abs(branch_point(saddle_node(contact, 1), contact, 1).phase) < 1e-3)
    True
    """
    return _by_blocks(_saddle_node, contact.release, *_columns(contact, n))


def _saddle_node(release, omega, zeta, n):
    contact = SpringDamper(omega, zeta, release)
    grid = _scan(*_range(contact, n), 1 / omega)
    return _fold(contact, n, grid, branch_point(grid, contact, n))


def _fold(contact, n, grid, points):
    """The saddle-node, from the points of the branch along a grid."""
    args = contact.frequency_ratio, contact.damping_ratio, n
    values = saddle_node_function(points.trace, points.determinant)
    root = _zero(_floquet_function(contact.release, saddle_node_function), grid, values, args)
    width = _NEXT_TO * np.minimum(np.abs(root), 1 / contact.frequency_ratio)
    fold, ends = _fold_function(contact.release), (root - width, root + width)
    left, right = (fold(x, *args) for x in ends)
    closer = _close(fold, *ends, left * right < 0, args)
    return np.where(np.isnan(closer), root, closer)


def period_doubling(contact: SpringDamper, n: ArrayLike) -> np.ndarray:
    """Excess angle ε of the period doubling nearest to the saddle-node.

    NaN where the stable side has none.
    """
    fold = saddle_node(contact, n)
    return _by_blocks(_period_doubling, contact.release, *_columns(contact, n), fold)


def _period_doubling(release, omega, zeta, n, fold):
    low, high = _range(SpringDamper(omega, zeta, release), n)
    end = np.where(np.isnan(fold), high, fold)
    # The part of the scan on the stable side; its points beyond collapse there.
    grid = np.minimum(_scan(low, high, 1 / omega), end)
    flip = _floquet_function(release, period_doubling_function)
    args = omega, zeta, n
    return _zero(flip, grid, flip(grid, *args), args, last=True)


def _surplus_function(release):
    def surplus(excess, omega, zeta, n, lam):
        return branch_point(excess, SpringDamper(omega, zeta, release), n).amplitude - lam

    return surplus


def _stable_side(release, omega, zeta, n, lam):
    """ε of the orbit at Λ between short contacts and the saddle-node.

    One scan brackets both: Λ falls along it.
    """
    contact = SpringDamper(omega, zeta, release)
    low, high = _range(contact, n)
    grid = _scan(low, high, 1 / omega)
    points = branch_point(grid, contact, n)
    fold = _fold(contact, n, grid, points)
    # Without a fold Λ falls all the way, and the whole branch is this side.
    end = np.where(np.isnan(fold), high, fold)
    lowest = branch_point(end, contact, n).amplitude
    below = np.where(grid < end, points.amplitude, lowest) <= lam
    at = np.argmax(below, axis=0)
    found = np.any(below, axis=0) & (at > 0) & (lowest <= lam)
    left, right = (np.minimum(_at(grid, k), end) for k in (np.maximum(at - 1, 0), at))
    return _close(_surplus_function(release), left, right, found, (omega, zeta, n, lam))


def orbit_at(
    contact: SpringDamper, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
) -> SpringDamperOrbit:
    """The n-T orbits at given Λ; NaN entries where there is none.

    Parameters
    ----------
    contact : SpringDamper
        ϖ and ζ, scalars or arrays, and the release rule.
    n, amplitude : array_like
        Index of the family and Λ.
    side : Side
        Side of the saddle-node. Where the unstable side turns again, as it
        does for soft contacts, the orbit nearest to the saddle-node is meant;
        there may be others with longer contacts.

    Examples
    --------
    >>> orbit = orbit_at(SpringDamper(1e4, 0.0517), 1, 1.0)
    >>> abs(round(float(orbit.bounce_velocity) / np.pi, 3))
    1.0
    """
    omega, zeta, n, lam = _columns(contact, n, amplitude)
    local = SpringDamper(omega, zeta, contact.release)
    if side is Side.STABLE:
        excess = _by_blocks(_stable_side, contact.release, omega, zeta, n, lam)
    else:
        excess = _by_blocks(_unstable_side, contact.release, omega, zeta, n, lam)
    return SpringDamperOrbit.from_branch(branch_point(excess, local, n), local, n)


def _unstable_side(release, omega, zeta, n, lam):
    """ε of the orbit at Λ beyond the saddle-node that is nearest to it."""
    contact = SpringDamper(omega, zeta, release)
    fold, (_, high) = _saddle_node(release, omega, zeta, n), _range(contact, n)
    scale, surplus = _SCAN_START / omega, _surplus_function(release)
    steps = np.linspace(0, 1, _SCAN).reshape(-1, 1)
    outward = fold + scale * np.maximum((high - fold) / scale, 1.0) ** steps
    grid = np.minimum(np.concatenate([fold[np.newaxis], outward]), high)
    # The next turn of Λ is a point of the grid, so that no orbit next to it
    # is missed between two points.
    turn, turns = _bracket(branch_point(grid[1:], contact, n).fold)
    ends = _at(grid[1:], turn), _at(grid[1:], turn + 1)
    summit = _close(_fold_function(release), *ends, turns, (omega, zeta, n))
    grid = np.sort(np.concatenate([grid, np.where(turns, summit, high)[np.newaxis]]), axis=0)
    args = (omega, zeta, n, lam)
    index, found = _bracket(surplus(grid, *args))
    return _close(surplus, _at(grid, index), _at(grid, index + 1), found, args)


# Steps of the search for all orbits, in radians of the contact's oscillation and
# of the table's, which Λ(ε) follows; and how many are taken at most.
_FINE = 0.02
_MOST = 200_000


def orbits_at(contact: SpringDamper, n: int, amplitude: float) -> SpringDamperOrbit:
    """All n-T orbits of one contact at one Λ, in order of contact duration.

    Every root of Λ(ε) = Λ at which the ball comes in and leaves. The turns of Λ
    between the points of a fine grid are found first, so that two orbits next
    to a turn are not missed. For ϖ above some 10³ the search does not reach
    contacts longer than 2·10⁵ steps.

    Examples
    --------
    >>> orbits = orbits_at(SpringDamper(2.0, 0.05), 1, 0.9)
    >>> orbits.contact_duration.round(3).tolist(), orbits.is_stable().tolist()
    ([1.601, 2.249, 5.193], [True, False, True])
    """
    omega, zeta, index, lam = (x.reshape(1) for x in _columns(contact, n, amplitude))
    local = SpringDamper(omega, zeta, contact.release)
    low, high = (float(np.ravel(x)[0]) for x in _range(local, n))
    step = _FINE * min(1.0, float(contact.damped_frequency))
    fine = np.arange(low, min(high, low + _MOST * step), step)
    scan = _scan(np.array([low]), np.array([high]), 1 / omega)[:, 0]
    grid = np.unique(np.concatenate([fine, scan[scan <= fine[-1] + step]]))[:, np.newaxis]

    def roots(function, *more):
        values = function(grid, omega, zeta, index, *more)
        left, right = values[:-1, 0], values[1:, 0]
        at = np.nonzero((left < 0) != (right < 0))[0]
        args = tuple(np.broadcast_to(x, at.shape) for x in (omega, zeta, index, *more))
        return _close(function, grid[at, 0], grid[at + 1, 0], np.full(at.shape, True), args)

    turns = roots(_fold_function(contact.release))
    grid = np.sort(np.concatenate([grid, turns[:, np.newaxis]]), axis=0)
    excess = roots(_surplus_function(contact.release), lam)
    point = branch_point(excess, local, n)
    found = SpringDamperOrbit.from_branch(point, local, n)
    # A sign change at a pole of the branch is not a root.
    real = np.abs(found.amplitude - lam) <= 1e-6 * lam
    return found[real & (found.relative_impact_velocity < 0) & (found.relative_bounce_velocity > 0)]
