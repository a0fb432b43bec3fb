"""Continuation of n-T orbits: corrector, walks along the frequency ratio, branches along Λ.

The three equations of a family (`orbits.Family.equations`) for the four numbers of an orbit are
completed by a condition: a given amplitude, a given duration of the contact, a plane through a
predicted point, or a bifurcation. Newton's method is the corrector for all of them.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from bouncing_ball import restitution
from bouncing_ball.orbits import Family
from bouncing_ball.restitution import Numbers
from bouncing_ball.spring_damper import Contact, damping_ratio

Condition = Callable[[Family, NDArray], tuple[NDArray, NDArray]]
"""A function of orbits y, shape (4, ...), whose zero is wanted, and its derivative by y."""

WALK_START = 1e3
"""The frequency ratio at which walks start, from the orbit of the restitution model."""

STEPS_PER_DECADE = 16
"""Steps of a walk per decade of ϖ; a step is predicted to about an eighth of the orbit's change."""

SMALLEST_STEP = 1e-6
"""The step at which a continuation gives up."""

LEAST_FLIGHT = 8e-4
"""Flight at which a branch counts as merged with permanent contact. Its Λ then exceeds that of
permanent contact by less than the square of this, and the multipliers, which are divided by the
squared velocity of the impact, still have some digits."""

SPECIAL = ("saddle-node", "period doubling", "grazing")
"""The kinds of special points of a branch."""


class NoOrbit(ValueError):
    """There is no such orbit, or Newton's method does not find it."""


def at_amplitude(amplitude: Numbers) -> Condition:
    """The condition of an amplitude Λ."""

    def condition(family, y):
        return y[0] - amplitude, _unit(0, y)

    return condition


def at_duration(angle: Numbers) -> Condition:
    """The condition of a duration θ = ϖ τ_b of the contact."""

    def condition(family, y):
        return y[3] - angle, _unit(3, y)

    return condition


def on_plane(point: NDArray, normal: NDArray) -> Condition:
    """The condition of the plane through a point, as in pseudo-arclength continuation."""

    def condition(family, y):
        return np.sum(normal * (y - point), axis=0), normal

    return condition


def at_bifurcation(test: Callable[[Family, NDArray], NDArray]) -> Condition:
    """The condition that a test function of orbits vanishes, such as `Family.saddle_node_test`.

    Its derivative is by central differences with a step of 1e-6: errors of 1e-9 in it slow
    Newton's method down a little, and do not change the orbit to which it converges.
    """
    step = 1e-6
    shifts = step * np.hstack([np.zeros((4, 1)), np.eye(4), -np.eye(4)])

    def condition(family, y):
        around = y[:, np.newaxis] + shifts.reshape(4, 9, *np.ones(y.ndim - 1, dtype=int))
        values = test(family, around)
        return values[0], (values[1:5] - values[5:]) / (2 * step)

    return condition


def _unit(k: int, y: NDArray) -> NDArray:
    """The unit vector of a component, for orbits y."""
    unit = np.zeros_like(y)
    unit[k] = 1
    return unit


def correct(
    family: Family,
    guess: NDArray,
    condition: Condition,
    iterations: int = 12,
    tolerance: float = 1e-11,
) -> NDArray:
    """Orbits near the guesses that meet a condition, by Newton's method; NaN where it fails.

    Parameters
    ----------
    family : Family
    guess : ndarray, shape (4, ...)
    condition : Condition
    iterations : int
        The largest number of steps.
    tolerance : float
        The largest last step relative to 1 + |y|. As the steps fall quadratically, the error after
        a step of 1e-11 is that of rounding.
    """
    y = np.array(guess, dtype=float)
    step = np.full_like(y, np.inf)
    # A guess that is too far away can lead anywhere; its orbit becomes NaN in the end.
    with np.errstate(all="ignore"):
        for _ in range(iterations):
            value, gradient = condition(family, y)
            end = family.contact_end(y)
            values = np.concatenate([family.equations(y, end), value[np.newaxis]])
            matrix = np.concatenate([family.jacobian(y, end), gradient[np.newaxis]])
            step = _solve(matrix, values)
            y = y - step
            small = np.max(np.abs(step), axis=0) < tolerance * (1 + np.max(np.abs(y), axis=0))
            if np.all(small | ~np.isfinite(step).all(axis=0)):
                break
        small = np.max(np.abs(step), axis=0) < tolerance * (1 + np.max(np.abs(y), axis=0))
    return np.where(small, y, np.nan)


def _solve(matrix: NDArray, values: NDArray) -> NDArray:
    """Solve systems whose axes come first; NaN for those whose matrix is singular."""
    rows = np.moveaxis(matrix, (0, 1), (-2, -1))
    columns = np.moveaxis(values, 0, -1)[..., np.newaxis]
    try:
        found = np.linalg.solve(rows, columns)
    except np.linalg.LinAlgError:
        singular = np.linalg.det(rows) == 0
        rows = np.where(singular[..., np.newaxis, np.newaxis], np.nan, rows)
        found = np.linalg.solve(rows, columns)
    return np.moveaxis(found[..., 0], -1, 0)


def stiff_guess(family: Family, x: Numbers, impact_height: Numbers) -> NDArray:
    """The orbit of the restitution model with X and Y as a guess for a stiff contact.

    The contact lasts half a free oscillation, or less with the force release.
    """
    contact = family.contact
    damped = np.sqrt(1 - np.asarray(contact.damping_ratio) ** 2)
    angle = np.pi / damped
    if contact.release == "force":
        zeta = contact.damping_ratio
        angle = angle - np.arctan2(2 * zeta * damped, 1 - 2 * np.asarray(zeta) ** 2) / damped
    numbers = np.broadcast_arrays(
        np.hypot(x, impact_height),
        np.arctan2(impact_height, x),
        -restitution.bounce_velocity(family.n),
        angle,
    )
    return np.stack(numbers).astype(float)


def walk(family: Family, condition: Condition, x: NDArray, impact_height: NDArray) -> NDArray:
    """Orbits under a condition along ϖ, shape (4, cases, ratios), NaN where they are not reached.

    The walk starts at WALK_START, or at twice the largest ratio, with the orbit of the restitution
    model, and goes in equal steps of log ϖ to the most compliant contact; each orbit is predicted
    from the two before it. The orbits at the ratios of the family are then corrected side by side,
    from predictions of the same kind.

    Parameters
    ----------
    family : Family
        With one frequency ratio or several, shape (ratios,); n and ζ are numbers or have the shape
        (cases, 1).
    condition : Condition
        For orbits of the shapes (4, cases, 1) and (4, cases, ratios).
    x, impact_height : ndarray, shape (cases, 1)
        X and Y of the orbits of the restitution model.
    """
    ratios = np.atleast_1d(family.contact.frequency_ratio)
    stiffest = max(WALK_START, 2 * ratios.max())
    count = 3 + int(STEPS_PER_DECADE * np.log10(stiffest / ratios.min()))
    nodes = np.geomspace(stiffest, ratios.min(), count)
    stiff = _at_ratio(family, nodes[0])
    guess = stiff_guess(stiff, x, impact_height)
    path = [guess]
    for node in nodes:
        path.append(_reached(_at_ratio(family, node), guess, condition))
        guess = path[-1] if len(path) == 2 else 2 * path[-1] - path[-2]
    orbits = np.stack(path[1:])
    # The node before each ratio, and the one before that.
    before = np.clip(np.searchsorted(-nodes, -ratios, side="right") - 1, 1, count - 2)
    part = np.log(ratios / nodes[before]) / np.log(nodes[1] / nodes[0])
    latest = orbits[before, ..., 0]
    guess = latest + part[:, np.newaxis, np.newaxis] * (latest - orbits[before - 1, ..., 0])
    return _reached(_at_ratio(family, ratios), np.moveaxis(guess, 0, -1), condition)


def _reached(family: Family, guess: NDArray, condition: Condition) -> NDArray:
    """The orbits predicted by a walk; NaN where they have ceased.

    There Newton's method finds none, or one of another branch, which is far from the prediction, or
    a solution without the signs of an orbit.
    """
    y = correct(family, guess, condition)
    with np.errstate(invalid="ignore"):
        near = (np.abs(y - guess)[[1, 3]] < 0.5).all(axis=0)
        return np.where(near & family.possible(y), y, np.nan)


def _at_ratio(family: Family, ratio: Numbers) -> Family:
    """The same family on contacts of another frequency ratio."""
    return replace(family, contact=replace(family.contact, frequency_ratio=ratio))


def stable_orbits(
    n: int,
    r: Numbers,
    amplitude: Numbers,
    ratios: Numbers,
    release: str = "displacement",
) -> NDArray:
    """The orbits on the stable side of the saddle-node at given amplitudes along ϖ.

    Parameters
    ----------
    n : int
    r, amplitude : array_like, shape (cases,)
        Restitution coefficient and Λ of each case.
    ratios : array_like, shape (ratios,)
        Frequency ratios ϖ.
    release : str

    Returns
    -------
    ndarray, shape (4, cases, ratios)
        NaN where the orbits of the stiff contacts have ceased.

    Raises
    ------
    NoOrbit
        If all amplitudes lie below the saddle-node of the stiff limit, the restitution model
        (Eq. 7); orbits of compliant contacts alone are not searched for.
    """
    r, amplitude = np.broadcast_arrays(np.atleast_1d(r), np.atleast_1d(amplitude))
    contact = Contact(np.atleast_1d(ratios), damping_ratio(r)[:, np.newaxis], release)
    return _upper_orbits(Family(n, contact), amplitude[:, np.newaxis])


def _upper_orbits(family: Family, amplitude: NDArray) -> NDArray:
    """The orbits of `stable_orbits`, for a family and amplitudes of the shape (cases, 1)."""
    r = family.contact.restitution
    x = np.broadcast_to(restitution.saddle_node(family.n, r), amplitude.shape)
    if np.all(amplitude < x):
        raise NoOrbit(
            f"{family.n}-T orbits exist from Λ = {x.min():.6g} on (Eq. 7 for a free impact with "
            f"r = {np.max(r):.6g}), and the largest Λ is {amplitude.max():g}"
        )
    impact_height = np.sqrt(np.where(amplitude < x, np.nan, amplitude**2 - x**2))
    return walk(family, at_amplitude(amplitude), x, impact_height)


def bifurcations(n: Numbers, kind: str, contact: Contact) -> NDArray:
    """The saddle-nodes, or the period doublings, that bound the stable orbits, along the frequency
    ratios of a contact.

    Parameters
    ----------
    n : array_like, shape (families,)
    kind : str
        ``saddle-node`` or ``period doubling``.
    contact : Contact
        With one frequency ratio or several, shape (ratios,); the damping ratio is a number or has
        the shape (families, 1).

    Returns
    -------
    ndarray, shape (4, families, ratios)
        NaN where it is not reached.
    """
    n = np.atleast_1d(n)[:, np.newaxis]
    x = restitution.saddle_node(n, contact.restitution)
    impact_height = np.zeros_like(x)
    test = Family.saddle_node_test
    if kind == "period doubling":
        impact_height = impact_height + restitution.period_doubling_height(contact.restitution)
        test = Family.period_doubling_test
    return walk(Family(n, contact), at_bifurcation(test), x, impact_height)


@dataclass(frozen=True)
class Special:
    """A special point of a branch: its kind, its orbit y, and its place, which is the length of the
    branch up to it over the whole length.
    """

    kind: str
    orbit: NDArray
    place: float


class End(NamedTuple):
    """Where a branch ends.

    Attributes
    ----------
    kind
        "largest amplitude", "permanent contact" or, where the continuation fails, "inside".
    reason
        The reason as text.
    """

    kind: str
    reason: str


VANISHES = End("inside", "the amplitude vanishes, as it does for undamped contacts only")
"""End of the branch of an undamped contact, whose phase is not defined at Λ = 0."""

MERGES = End("permanent contact", "the flight vanishes: the orbit merges with permanent contact")
"""End of a branch whose flight vanishes."""


@dataclass(frozen=True)
class Branch:
    """A branch of orbits along Λ, from the unstable to the stable side.

    Attributes
    ----------
    orbits
        Orbits, shape (4, points), with chords of equal length between neighbours.
    special
        Special points in the order of the branch.
    ends
        Its ends at the unstable and at the stable side.
    """

    orbits: NDArray
    special: list[Special]
    ends: tuple[End, End]


def branch(family: Family, amplitude_max: float, points: int, largest_step: float = 0.2) -> Branch:
    """Follow the orbits of a family from the stable side at an amplitude round the saddle-node.

    Parameters
    ----------
    family : Family
        With one frequency ratio.
    amplitude_max : float
        Λ at which the branch begins, and at which it ends unless the flight vanishes before.
    points : int
        The number of orbits.
    largest_step : float
        The largest step of the pseudo-arclength continuation in (Λ, φ, z′_i, θ).

    Raises
    ------
    NoOrbit
        If there is no orbit to begin with, or the continuation fails.
    """
    ratio = float(family.contact.frequency_ratio)
    start = _upper_orbits(family, np.array([[amplitude_max]]))[:, 0, 0]
    if np.isnan(start).any():
        raise NoOrbit(f"no {family.n}-T orbit is found at Λ = {amplitude_max:g} and ϖ = {ratio:g}")
    reached = End("largest amplitude", f"amplitude = {amplitude_max:g} is reached")
    path, end = _follow(family, start, amplitude_max, largest_step)
    if np.isnan(path).any():
        raise NoOrbit(f"the end of a {family.n}-T branch is not found at ϖ = {ratio:g}")
    path = path[:, ::-1]
    orbits = _equal_chords(family, path, points)
    found = []
    for kind, test in _tests(family).items():
        for orbit in _zeros(family, path, test):
            found.append(Special(kind, orbit, _place(orbit, orbits)))
    ends = (end or reached, reached)
    return Branch(orbits, sorted(found, key=lambda each: each.place), ends)


def _tests(family: Family) -> dict[str, Callable[[NDArray], NDArray]]:
    """The functions that vanish at each kind of special point."""
    functions = (family.saddle_node_test, family.period_doubling_test, family.clearance)
    return dict(zip(SPECIAL, functions, strict=True))


def _tangent(family: Family, y: NDArray) -> NDArray:
    """Unit tangent of the family at an orbit, the null vector of its 3 × 4 derivative."""
    return np.linalg.svd(family.jacobian(y))[2][3]


def _follow(
    family: Family, start: NDArray, amplitude_max: float, largest_step: float
) -> tuple[NDArray, End | None]:
    """Pseudo-arclength continuation from an orbit towards smaller Λ, and round the saddle-node.

    A step is halved if the corrector fails or the tangent turns by more than about 14 degrees, and
    grows otherwise. Returns the orbits, shape (4, steps), and the end of the branch unless it is at
    the largest amplitude.
    """
    path = [start]
    y = start
    step = largest_step / 8
    direction = _tangent(family, y)
    direction = direction * -np.sign(direction[0])
    while step > SMALLEST_STEP:
        guess = y + step * direction
        new = correct(family, guess, on_plane(guess, direction), iterations=5)
        # Near Λ = 0 a step can jump over a sharp turn of φ to the same orbits with Λ < 0.
        if np.isnan(new).any() or np.linalg.norm(new - y) > 1.5 * step or new[0] < 0:
            step = step / 2
            continue
        if family.period - new[3] / family.contact.frequency_ratio < LEAST_FLIGHT:
            angle = family.contact.frequency_ratio * (family.period - LEAST_FLIGHT)
            return np.stack([*path, correct(family, new, at_duration(angle))], axis=1), MERGES
        if new[0] > amplitude_max:
            last = correct(family, new, at_amplitude(amplitude_max))
            return np.stack([*path, last], axis=1), None
        following = _tangent(family, new)
        following = following * np.sign(direction @ following)
        if direction @ following < 0.97:
            step = step / 2
            continue
        path.append(new)
        y = new
        direction = following
        step = min(1.5 * step, largest_step)
    lost = End("inside", f"the continuation does not get beyond amplitude = {y[0]:.6g}")
    return np.stack(path, axis=1), VANISHES if y[0] < 10 * SMALLEST_STEP else lost


def _equal_chords(family: Family, path: NDArray, points: int) -> NDArray:
    """Orbits along a path at equal distances between neighbours, shape (4, points).

    A spline through the path is sampled, and the samples are corrected to orbits. The places of the
    samples are moved until the distances are equal: then the orbits depend on the branch alone, and
    not on the steps by which it was followed.
    """
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path), axis=0))])
    curve = CubicSpline(length, path, axis=1)
    places = np.linspace(0, length[-1], points)
    for _ in range(30):
        guess = curve(places)
        orbits = correct(family, guess, on_plane(guess, curve(places, 1)))
        orbits[:, [0, -1]] = path[:, [0, -1]]
        if np.isnan(orbits).any():
            raise NoOrbit(f"a {family.n}-T branch cannot be sampled at {points} points")
        chords = np.linalg.norm(np.diff(orbits), axis=0)
        # Rounding errors of orbits are some 1e-14, and chords are differences of them.
        if np.ptp(chords) < 1e-12 * max(chords.mean(), 0.1):
            break
        passed = np.concatenate([[0], np.cumsum(chords)])
        places = np.interp(np.linspace(0, passed[-1], points), passed, places)
    else:
        raise NoOrbit(f"the {points} points of a {family.n}-T branch do not become equidistant")
    return orbits


def _zeros(family: Family, path: NDArray, test: Callable[[NDArray], NDArray]) -> list[NDArray]:
    """The orbits of a path at which a test function vanishes, by bracketing between its points."""
    values = test(path)
    found = []
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        before = path[:, i]
        chord = path[:, i + 1] - before

        def orbit(part, before=before, chord=chord):
            guess = before + part * chord
            found = correct(family, guess, on_plane(guess, chord))
            return guess if np.isnan(found).any() else found

        zero = orbit(brentq(lambda part: float(test(orbit(part))), 0, 1, xtol=1e-15))
        # At a pole of the test function its sign changes, too, but its value does not become small;
        # at Λ = 0 the phase is not defined.
        if zero[0] > 1e-6 and abs(test(zero)) < 1e-3 * np.abs(values[i : i + 2]).max():
            found.append(zero)
    return found


def _place(orbit: NDArray, orbits: NDArray) -> float:
    """Where an orbit lies on a branch of equal chords, as a part of its length."""
    start = orbits[:, :-1]
    chords = np.diff(orbits)
    part = np.sum((orbit[:, np.newaxis] - start) * chords, axis=0) / np.sum(chords**2, axis=0)
    part = np.clip(part, 0, 1)
    distance = np.linalg.norm(orbit[:, np.newaxis] - start - part * chords, axis=0)
    nearest = np.argmin(distance)
    return float((nearest + part[nearest]) / chords.shape[1])
