"""Find n-T orbits, and follow them along the frequency ratio or along the amplitude.

A family has three equations for the four unknowns of an orbit (`orbits.Family.equations`). A
condition is the fourth equation: a given amplitude, a given duration of the contact, a plane
through a predicted orbit, or a bifurcation. The corrector solves the four equations by Newton's
method.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from bouncing_ball import restitution
from bouncing_ball.orbits import Family, NoOrbit
from bouncing_ball.restitution import Numbers, finite, is_stable, required
from bouncing_ball.spring_damper import NO_CONTACT, Contact, free_duration

Condition = Callable[[Family, NDArray], tuple[NDArray, NDArray]]
"""Fourth equation of an orbit: a function of the family and of orbits y, shape (4, ...). It returns
the residual, shape (...), and its derivative with respect to y, shape (4, ...)."""

WALK_START = 1e3
"""Frequency ratio ϖ at which a walk starts, from the orbit of the restitution model. If the largest
ϖ of a walk exceeds half of this value, the walk starts at twice that ϖ."""

STEPS_PER_DECADE = 16
"""Minimum number of steps of a walk per decade of ϖ. The error of a prediction is then about one
eighth of the change of the orbit in the step."""

PASSES = 300
"""Maximum number of passes that make the points of a branch equidistant. Fewer points need more: 11
points up to the largest Λ of the schema, 100, need 170."""

SMALLEST_STEP = 1e-6
"""Step length at or below which a continuation ends."""

MOST_ORBITS = 10_000
"""Maximum number of orbits of a continuation, which would not end on a closed curve of orbits. The
branch of Figure 8 needs 72 with the step of the configuration."""

LEAST_FLIGHT = 8e-4
"""Duration of the flight below which a branch counts as merged with permanent contact. At this
duration, Λ exceeds the threshold of permanent contact by less than the square of the duration,
6.4e-7. At shorter durations the multipliers would lose their last digits, because they are divided
by the squared velocity of the impact."""

SPECIAL = ("saddle-node", "period doubling", "grazing")
"""Kinds of special points of a branch."""


def at_amplitude(amplitude: Numbers) -> Condition:
    """Condition that the amplitude Λ is given."""

    def condition(family, y):
        return y[0] - amplitude, _unit(0, y)

    return condition


def at_duration(angle: Numbers) -> Condition:
    """Condition that the scaled duration θ = ϖ τ_b of the contact is given."""

    def condition(family, y):
        return y[3] - angle, _unit(3, y)

    return condition


def on_plane(point: NDArray, normal: NDArray) -> Condition:
    """Condition that the orbit is on a plane, as in pseudo-arclength continuation.

    The plane contains `point` and is perpendicular to `normal`, both of the shape (4, ...).
    """

    def condition(family, y):
        return np.sum(normal * (y - point), axis=0), normal

    return condition


def at_bifurcation(test: Callable[[Family, NDArray], NDArray]) -> Condition:
    """Condition that a test function vanishes, such as `Family.saddle_node_test`.

    Its derivative is computed by central differences with a step of 1e-6, with an error of about
    1e-9. This error slows the convergence of Newton's method, but does not change the limit.
    """
    step = 1e-6
    shifts = step * np.hstack([np.zeros((4, 1)), np.eye(4), -np.eye(4)])

    def condition(family, y):
        around = y[:, np.newaxis] + shifts.reshape(4, 9, *np.ones(y.ndim - 1, dtype=int))
        values = test(family, around)
        return values[0], (values[1:5] - values[5:]) / (2 * step)

    return condition


def _unit(k: int, y: NDArray) -> NDArray:
    """Unit vector of component k, of the shape of the orbits y."""
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
    """Find the orbits of a family that satisfy a condition, by Newton's method.

    Parameters
    ----------
    family : Family
    guess : ndarray, shape (4, ...)
        Initial guesses of the orbits.
    condition : Condition
    iterations : int
        Maximum number of Newton steps.
    tolerance : float
        Maximum size of the last step relative to 1 + |y|, in the maximum norm. Newton's method
        converges quadratically, so only rounding errors remain after a step of 1e-11.

    Returns
    -------
    ndarray, shape (4, ...)
        NaN if Newton's method does not converge.
    """
    y = np.array(guess, dtype=float)
    step = np.full_like(y, np.inf)
    # A distant guess can overflow or make the matrix singular. Its orbit becomes NaN.
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
    """Solve linear systems, shape (4, 4, ...) and (4, ...); NaN if a matrix is singular."""
    rows = np.moveaxis(matrix, (0, 1), (-2, -1))
    columns = np.moveaxis(values, 0, -1)[..., np.newaxis]
    try:
        steps = np.linalg.solve(rows, columns)
    except np.linalg.LinAlgError:
        singular = np.linalg.det(rows) == 0
        rows = np.where(singular[..., np.newaxis, np.newaxis], np.nan, rows)
        steps = np.linalg.solve(rows, columns)
    return np.moveaxis(steps[..., 0], -1, 0)


def stiff_guess(family: Family, x: Numbers, impact_height: Numbers) -> NDArray:
    """Orbit of the restitution model with given X and Y, as a guess for a stiff contact.

    The contact of the guess lasts as long as a free impact.
    """
    contact = family.contact
    numbers = np.broadcast_arrays(
        np.hypot(x, impact_height),
        np.arctan2(impact_height, x),
        -restitution.bounce_velocity(family.n),
        free_duration(contact.damping_ratio, contact.release),
    )
    return np.stack(numbers).astype(float)


def walk(family: Family, condition: Condition, x: NDArray, impact_height: NDArray) -> NDArray:
    """Follow the orbits that satisfy a condition along ϖ, from stiff to compliant contacts.

    The walk starts at WALK_START or at twice the largest ratio, whichever is larger. There, the
    guess is the orbit of the restitution model. The walk takes equal steps of log ϖ to the smallest
    ratio, and extrapolates each orbit linearly from the two orbits before it. The orbits at the
    ratios of the family are extrapolated in the same way, and corrected all at once.

    Parameters
    ----------
    family : Family
        Family with one or several frequency ratios, shape (ratios,). n and ζ are numbers or have
        the shape (cases, 1).
    condition : Condition
        Condition for orbits of the shapes (4, cases, 1) and (4, cases, ratios).
    x, impact_height : ndarray, shape (cases, 1)
        X and Y of the orbits of the restitution model.

    Returns
    -------
    ndarray, shape (4, cases, ratios)
        NaN if the walk does not reach the orbit.
    """
    ratios = np.atleast_1d(finite("ϖ", family.contact.frequency_ratio))
    stiffest = max(WALK_START, 2 * ratios.max())
    count = 3 + int(STEPS_PER_DECADE * np.log10(stiffest / ratios.min()))
    nodes = np.geomspace(stiffest, ratios.min(), count)
    stiff = _at_ratio(family, nodes[0])
    guess = stiff_guess(stiff, x, impact_height)
    path = [guess]
    for node in nodes:
        # A node only predicts the next orbits. After a step of 1e-6, its error is about 1e-12.
        path.append(_reached(_at_ratio(family, node), guess, condition, tolerance=1e-6))
        guess = path[-1] if len(path) == 2 else 2 * path[-1] - path[-2]
    orbits = np.stack(path[1:])
    # Index of the last node before each ratio. Extrapolate from this node and its predecessor.
    before = np.clip(np.searchsorted(-nodes, -ratios, side="right") - 1, 1, count - 2)
    part = np.log(ratios / nodes[before]) / np.log(nodes[1] / nodes[0])
    latest = orbits[before, ..., 0]
    guess = latest + part[:, np.newaxis, np.newaxis] * (latest - orbits[before - 1, ..., 0])
    return _reached(_at_ratio(family, ratios), np.moveaxis(guess, 0, -1), condition)


def _reached(
    family: Family, guess: NDArray, condition: Condition, tolerance: float = 1e-11
) -> NDArray:
    """Orbits that a walk has predicted, corrected; NaN if they no longer exist.

    An orbit no longer exists if one of the following is true:

    1. Newton's method does not converge.
    2. Newton's method converges to another branch: φ or θ differs from the prediction by 0.5 or
       more.
    3. The solution does not have the signs of an orbit (`Family.possible`).
    """
    y = correct(family, guess, condition, tolerance=tolerance)
    with np.errstate(invalid="ignore"):
        near = (np.abs(y - guess)[[1, 3]] < 0.5).all(axis=0)
        return np.where(near & family.possible(y), y, np.nan)


def _at_ratio(family: Family, ratio: Numbers) -> Family:
    """Copy of a family with another frequency ratio."""
    return replace(family, contact=replace(family.contact, frequency_ratio=ratio))


def upper_orbits(
    n: int,
    r: Numbers,
    amplitude: Numbers,
    ratios: Numbers,
    release: str = "displacement",
) -> NDArray:
    """Orbits that are stable next to the saddle-node, at given amplitudes, along ϖ.

    At a larger amplitude they may have lost their stability (`stable_orbits`).

    Parameters
    ----------
    n : int
        Number of table periods in one cycle.
    r, amplitude : array_like, shape (cases,)
        Restitution coefficient and Λ of each case.
    ratios : array_like, shape (ratios,)
        Frequency ratios ϖ.
    release : str
        Release condition, ``displacement`` or ``force``.

    Returns
    -------
    ndarray, shape (4, cases, ratios)
        Orbits y. NaN if the walk from stiff contacts does not reach the orbit.

    Raises
    ------
    NoOrbit
        If no contact has one of the restitution coefficients (`damping_ratio`), or all amplitudes
        are below the saddle-node of stiff contacts (Eq. 7, with the restitution coefficient of a
        free impact). The search does not find orbits that exist on compliant
        contacts only.

    >>> upper_orbits(1, 0.65, [0.9, 1.0], [10.0, 100.0]).shape
    (4, 2, 2)
    """
    family, amplitude = _families(n, r, amplitude, ratios, release)
    return _upper_orbits(family, amplitude)


def stable_orbits(
    n: int,
    r: Numbers,
    amplitude: Numbers,
    ratios: Numbers,
    release: str = "displacement",
) -> NDArray:
    """Stable orbits at given amplitudes, along ϖ: `upper_orbits`, NaN where they are unstable.

    >>> stable_orbits(1, 0.65, [1.0, 1.5], [100.0])[0, :, 0].tolist()
    [1.0, nan]
    """
    family, amplitude = _families(n, r, amplitude, ratios, release)
    y = _upper_orbits(family, amplitude)
    return np.where(is_stable(*family.trace_and_determinant(y)), y, np.nan)


def _families(
    n: int, r: Numbers, amplitude: Numbers, ratios: Numbers, release: str
) -> tuple[Family, NDArray]:
    """Family of contacts with the restitution coefficients r, and amplitudes, shape (cases, 1)."""
    r, amplitude = np.broadcast_arrays(np.atleast_1d(finite("r", r)), np.atleast_1d(amplitude))
    contact = Contact.of_restitution(np.atleast_1d(ratios), r[:, np.newaxis], release)
    return Family(n, contact), amplitude[:, np.newaxis]


def _upper_orbits(family: Family, amplitude: NDArray) -> NDArray:
    """Orbits as in `upper_orbits`, for a family and amplitudes of the shape (cases, 1)."""
    finite("Λ", amplitude)
    r = family.contact.restitution
    if np.isnan(r).all():
        raise NoOrbit(f"no contact has this restitution: {NO_CONTACT}")
    x = np.broadcast_to(restitution.saddle_node(family.n, r), amplitude.shape)
    if np.all(amplitude < x):
        raise NoOrbit(
            f"{family.n}-T orbits on stiff contacts need Λ >= {x.min():.6g} (Eq. 7 for a free "
            f"impact with r = {np.max(r):.6g}), and the largest Λ is {amplitude.max():g}: "
            "give a larger Λ"
        )
    impact_height = np.sqrt(np.where(amplitude < x, np.nan, amplitude**2 - x**2))
    return walk(family, at_amplitude(amplitude), x, impact_height)


def bifurcations(n: Numbers, kind: str, contact: Contact) -> NDArray:
    """Bifurcations at the ends of the range of `stable_orbits`, along ϖ.

    Parameters
    ----------
    n : array_like, shape (families,)
        Number of table periods in one cycle of each family.
    kind : str
        ``saddle-node`` or ``period doubling``.
    contact : Contact
        Contact with one or several frequency ratios, shape (ratios,). The damping ratio is a number
        or has the shape (families, 1).

    Returns
    -------
    ndarray, shape (4, families, ratios)
        Orbits y at the bifurcations. NaN if the walk from stiff contacts does not reach the
        bifurcation.

    Raises
    ------
    ValueError
        If the kind is another one.
    """
    if kind not in SPECIAL[:2]:
        raise ValueError(f"the kind is {kind!r}: give {' or '.join(SPECIAL[:2])}")
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
    """Special point of a branch.

    Attributes
    ----------
    kind : str
        One of SPECIAL.
    orbit : ndarray, shape (4,)
        Orbit y.
    place : float
        Position on the branch: length of the branch from its unstable end to the point, divided by
        the length of the whole branch.
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
    """Branch of orbits along Λ, from the unstable to the stable side.

    Attributes
    ----------
    orbits : ndarray, shape (4, points)
        Orbits y. The chords between neighbours have equal lengths.
    special : list of Special
        Special points, in order of their position on the branch.
    ends : tuple of End
        Ends at the unstable side and at the stable side.
    """

    orbits: NDArray
    special: list[Special]
    ends: tuple[End, End]


def branch(family: Family, amplitude_max: float, points: int, largest_step: float = 0.2) -> Branch:
    """Follow a family of orbits from the stable side, round the saddle-node, to the unstable side.

    Parameters
    ----------
    family : Family
        Family with one frequency ratio.
    amplitude_max : float
        Amplitude Λ at which the branch begins on the stable side. The unstable side ends at the
        same amplitude. It ends earlier if the flight vanishes, if Λ vanishes (undamped contacts
        only), if the steps become too small, or after MOST_ORBITS.
    points : int
        Number of orbits.
    largest_step : float
        Maximum step of the pseudo-arclength continuation in (Λ, φ, z′_i, θ).

    Raises
    ------
    NoOrbit
        If no orbit is found at `amplitude_max`, or the corrector fails at an end of the branch or
        at one of its points.
    """
    whole = np.greater_equal(points, 2) & (np.mod(points, 1) == 0)
    required("points", points, ~whole, "a whole number of points >= 2")
    positive = np.greater(largest_step, 0) & np.isfinite(largest_step)
    required("largest_step", largest_step, ~positive, "a finite step > 0")
    ratio = float(family.contact.frequency_ratio)
    start = _upper_orbits(family, np.array([[amplitude_max]]))[:, 0, 0]
    if np.isnan(start).any():
        raise NoOrbit(
            f"no {family.n}-T orbit is found at Λ = {amplitude_max:g} and ϖ = {ratio:g}: "
            "give a larger Λ or ϖ"
        )
    reached = End("largest amplitude", f"amplitude = {amplitude_max:g} is reached")
    path, end = _follow(family, start, amplitude_max, largest_step)
    if np.isnan(path).any():
        raise NoOrbit(
            f"the end of a {family.n}-T branch is not found at ϖ = {ratio:g}: "
            "give a smaller largest_step"
        )
    path = path[:, ::-1]
    orbits = _equal_chords(family, path, points)
    special = []
    for kind, test in _tests(family).items():
        for orbit in _zeros(family, path, test):
            special.append(Special(kind, orbit, _place(orbit, orbits)))
    ends = (end or reached, reached)
    return Branch(orbits, sorted(special, key=lambda point: point.place), ends)


SCANNED = 1000
"""Number of durations at which `laid_ranges` looks for stable orbits: it may miss ranges in which
τ_b changes by less than 0.02.
"""


def laid_ranges(family: Family, amplitude_max: float) -> NDArray:
    """Ranges of stable, admissible orbits on the branch that begins at permanent contact.

    These orbits have long contacts; a ball that is laid on the table may end on them. The branch is
    followed in closed form (`Family.of_duration`), from flights of `LEAST_FLIGHT` to the first
    amplitude above `amplitude_max`.

    Returns
    -------
    ndarray, shape (ranges, 2, 2)
        Λ and τ_b (second axis) at both ends of each range (last axis), the longest contacts first.

    Raises
    ------
    ValueError
        If the contact has the force release: then no contact pulls, and this branch is not known.

    Examples
    --------
    >>> contact = Contact.of_restitution(10.0, 0.65)
    >>> laid_ranges(Family(1, contact), 1.2)[:, 0].round(4).tolist()
    [[0.9904, 1.1083]]
    """
    if family.contact.release != "displacement":
        raise ValueError("the branch from permanent contact needs the displacement release")

    def orbits(flight):
        return family.of_duration(family.period - flight)

    def are_followed(flight):
        y = orbits(flight)
        stable = family.possible(y) & is_stable(*family.trace_and_determinant(y))
        stable[stable] = family.admissible(y[:, stable])
        return stable

    def edge(inside, outside):
        for _ in range(50):
            middle = (inside + outside) / 2
            if are_followed(np.array([middle]))[0]:
                inside = middle
            else:
                outside = middle
        return inside

    flight = np.geomspace(LEAST_FLIGHT, 0.99 * family.period, SCANNED)
    beyond = np.flatnonzero(orbits(flight)[0] > amplitude_max)
    flight = flight[: beyond[0]] if beyond.size else flight
    followed = np.concatenate([[False], are_followed(flight), [False]])
    ranges = []
    for first, after in np.flatnonzero(np.diff(followed)).reshape(-1, 2):
        longest = edge(flight[first], flight[first - 1]) if first else flight[0]
        last = flight[after - 1]
        shortest = edge(last, flight[after]) if after < flight.size else last
        edges = np.array([longest, shortest])
        ranges.append([orbits(edges)[0], family.period - edges])
    return np.array(ranges).reshape(-1, 2, 2)


def _tests(family: Family) -> dict[str, Callable[[NDArray], NDArray]]:
    """Test function of each kind of special point, which vanishes there."""
    functions = (family.saddle_node_test, family.period_doubling_test, family.clearance)
    return dict(zip(SPECIAL, functions, strict=True))


def _tangent(family: Family, y: NDArray) -> NDArray:
    """Unit tangent of the family at an orbit: null vector of its 3 × 4 Jacobian matrix."""
    return np.linalg.svd(family.jacobian(y))[2][3]


def _follow(
    family: Family, start: NDArray, amplitude_max: float, largest_step: float
) -> tuple[NDArray, End | None]:
    """Pseudo-arclength continuation from an orbit towards smaller Λ, and round the saddle-node.

    A step is halved if the corrector fails or if the tangent turns by more than about 14 degrees.
    Otherwise the next step is longer by a factor of 1.5, up to the largest step.

    Returns the orbits, shape (4, steps), and the end of the branch, or None if it ends at
    `amplitude_max`. There are at most MOST_ORBITS.
    """
    path = [start]
    y = start
    step = largest_step / 8
    direction = _tangent(family, y)
    direction = direction * -np.sign(direction[0])
    while step > SMALLEST_STEP and len(path) < MOST_ORBITS:
        guess = y + step * direction
        new = correct(family, guess, on_plane(guess, direction), iterations=5)
        # Near Λ = 0 the branch turns sharply in φ. A long step can cross to Λ < 0, where the branch
        # describes the same orbits again.
        if np.isnan(new).any() or new[0] < 0:
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
    what = f"stops after {MOST_ORBITS} orbits at" if step > SMALLEST_STEP else "does not get beyond"
    lost = End("inside", f"the continuation {what} amplitude = {y[0]:.6g}")
    return np.stack(path, axis=1), VANISHES if y[0] < 10 * SMALLEST_STEP else lost


def _equal_chords(family: Family, path: NDArray, points: int) -> NDArray:
    """Orbits along a path with equal distances between neighbours, shape (4, points).

    Samples of a spline through the path are corrected to orbits. The samples are moved until the
    distances are equal. The orbits then depend on the branch only, and not on the steps of the
    continuation.
    """
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path), axis=0))])
    curve = CubicSpline(length, path, axis=1)
    places = np.linspace(0, length[-1], points)
    for _ in range(PASSES):
        guess = curve(places)
        orbits = correct(family, guess, on_plane(guess, curve(places, 1)))
        orbits[:, [0, -1]] = path[:, [0, -1]]
        if np.isnan(orbits).any():
            raise NoOrbit(
                f"a {family.n}-T branch cannot be sampled at {points} points: "
                "give a smaller largest_step"
            )
        chords = np.linalg.norm(np.diff(orbits), axis=0)
        # Chords are differences of orbits, whose rounding errors are about 1e-14.
        if np.ptp(chords) < 1e-12 * max(chords.mean(), 0.1):
            break
        passed = np.concatenate([[0], np.cumsum(chords)])
        places = np.interp(np.linspace(0, passed[-1], points), passed, places)
    else:
        raise NoOrbit(
            f"could not space the {points} points of a {family.n}-T branch evenly: "
            "give another number of points"
        )
    return orbits


def _zeros(family: Family, path: NDArray, test: Callable[[NDArray], NDArray]) -> list[NDArray]:
    """Orbits of a path at which a test function vanishes.

    Each change of sign between two points of the path brackets one zero.
    """
    values = test(path)
    orbits = []
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        before = path[:, i]
        chord = path[:, i + 1] - before

        def orbit(part, before=before, chord=chord):
            guess = before + part * chord
            return correct(family, guess, on_plane(guess, chord))

        orbits.append(orbit(brentq(lambda part: float(test(orbit(part))), 0, 1, xtol=1e-15)))
    return orbits


def _place(orbit: NDArray, orbits: NDArray) -> float:
    """Position of an orbit on a branch of equal chords, as a fraction of its length."""
    start = orbits[:, :-1]
    chords = np.diff(orbits)
    part = np.sum((orbit[:, np.newaxis] - start) * chords, axis=0) / np.sum(chords**2, axis=0)
    part = np.clip(part, 0, 1)
    distance = np.linalg.norm(orbit[:, np.newaxis] - start - part * chords, axis=0)
    nearest = np.argmin(distance)
    return float((nearest + part[nearest]) / chords.shape[1])
