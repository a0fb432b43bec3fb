r"""Curves of special orbits in two parameters, with their points of codimension two.

A special orbit solves the equations of an orbit and one more, g = 0. With two free parameters such
orbits lie on a curve, which is followed by pseudo-arclength as branches are. At a saddle-node and a
period doubling the matrix A of the chain of legs, which is closed with the multiplier 1 or -1, is
singular. There g comes from a matrix that is bordered by the null vectors of a neighbour, c and b::

    A v + g b = 0,   c v = 1,        wA + g c = 0,   w b = 1,        ∂g/∂z = -w (∂A/∂z) v

A is also singular where a release is lost, for every orbit: the rate ρ of the release function is
zero there, and with it the whole column of T. These zeros are divided out: Newton's method solves
g/∏ρ = 0.

Other special orbits have the tests of `continuation.KINDS`. On a curve these points are named:

* a cusp, where two saddle-nodes meet: a = 0 in their normal form;
* a generalized period doubling, where b = 0: doublings are supercritical on one side of it only;
* the resonances 1:1 and 1:2, where both multipliers are 1, or -1: their product is 1;
* special orbits of another kind, where for example a flight begins to graze the table.

A fold-flip, with the multipliers 1 and -1, does not occur, because the determinant of the return
map is a product of positive numbers.

Source: W. Govaerts, *Numerical Methods for Bifurcations of Dynamical Equilibria*, SIAM (2000), for
bordered matrices; Y. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, chapter 9.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import KroghInterpolator
from scipy.optimize import brentq

from bouncing_ball_beyond.balls import brief
from bouncing_ball_beyond.continuation import FollowedBranch
from bouncing_ball_beyond.equations import OrbitEquations, dense
from bouncing_ball_beyond.forms import (
    MULTIPLIERS,
    closed,
    coefficient,
    curvature,
    longest_step,
    null_vectors,
    one_impact_less,
)
from bouncing_ball_beyond.paths import Path, path_of, place_on
from bouncing_ball_beyond.periodic import OrbitNotFound, PeriodicOrbit
from bouncing_ball_beyond.special_orbits import (
    KINDS,
    OF_RESTS,
    halves_of,
    scales,
    value_and_gradient,
)

FIRST_STEP = 0.05
LONGEST_STEP = 0.2
SHORTEST_STEP = 1e-7
"""Lengths of steps, in the units of `continuation.scales`."""

STRAIGHT = 0.97
"""The least cosine of the angle between the tangents at the ends of a step."""

SHIFT = 1e-5
"""Shift of T in differences, whose errors, some 1e-10, do not move what Newton's method finds."""

RESONANT = 1e-6
"""A curve ends in a resonance if the product of the multipliers differs from 1 by less. Located at
a range's end, the determinant has at least ten digits."""

BESIDE = 1e-3
"""The share of a step next to an end of a curve in which nothing else is looked for.

Where a release is lost other tests are zero as well."""

ZERO = 1e-6
"""A test is zero if it is smaller, before a last step of 1e-8.

Where it changes its sign, at a share of a step that is known to 1e-12, it jumps if it is larger
than so much of its values at the ends."""

OTHER = 1e-3
"""A start that is farther from the corrected special orbit is no special orbit of its kind."""

DEGENERATE = {
    "saddle-node": ("cusp", "1:1 resonance"),
    "period doubling": ("generalized period doubling", "1:2 resonance"),
}
"""Where a or b is zero, and where both multipliers are the same."""


@dataclass(frozen=True, eq=False, repr=False)
class SpecialCurve(FollowedBranch):
    """Special orbits of one kind along two parameters: a `FollowedBranch` with their kind.

    Its ``special`` orbits are those of codimension two.
    """

    kind: str = ""

    def __repr__(self):
        return super().__repr__().replace("FollowedBranch", f"SpecialCurve: {self.kind}")

    @property
    def along(self) -> str:
        """The names of the two parameters."""
        return " and ".join(path.name for path in self.equations.along)

    def first(self, kind: str) -> PeriodicOrbit:
        """The first orbit of codimension two of a kind.

        Raises
        ------
        OrbitNotFound
            If the curve has none.
        """
        return self._first(kind, "this curve; its orbits of codimension two are")

    @cached_property
    def orbits(self) -> tuple[PeriodicOrbit, ...]:
        """The special orbits one by one."""
        return tuple(PeriodicOrbit(self.equations, row, self.kind) for row in self.z)


class _Point(NamedTuple):
    """A special orbit of a curve: z, and the tangent with normal · tangent = 1, shape (N,).

    ``border`` are the vectors v and w of length 1 near its null vectors, shape (kq,), and ``bent``
    the derivatives of the legs along v; both are None for kinds without a multiplier.
    """

    z: NDArray
    tangent: NDArray
    border: Any
    bent: Any


@dataclass(frozen=True)
class _System:
    """The equations of special orbits of a kind."""

    equations: OrbitEquations
    kind: str

    def border(self, z: NDArray) -> tuple[NDArray, NDArray] | None:
        """The null vectors v and w at a special orbit."""
        if self.kind not in MULTIPLIERS:
            return None
        derivatives = self.equations.linear(z[np.newaxis]).derivatives[0]
        return null_vectors(closed(derivatives, MULTIPLIERS[self.kind]))

    def condition(self, z, derivatives, border):
        """g at z, the gradient of g/∏ρ times ∏ρ, the null vectors, and the derivatives along v.

        ``derivatives`` are those of the legs at z and, if impacts have a T, on both sides of z.
        """
        if border is None:
            value, gradient, _ = value_and_gradient(self.equations, self.kind, z[np.newaxis])
            return value[0], gradient[0], None, None
        c, b = border
        size = len(c)
        matrix = np.zeros((size + 1, size + 1))
        matrix[:-1, :-1] = closed(derivatives[0], MULTIPLIERS[self.kind])
        matrix[:-1, -1] = b
        matrix[-1, :-1] = c
        right = np.zeros(size + 1)
        right[-1] = 1.0
        *v, value = np.linalg.solve(matrix, right)
        *w, _ = np.linalg.solve(matrix.T, right)
        new = np.array(v), np.array(w)
        step = longest_step(self.equations, z, new[0])
        bent = curvature(self.equations, z, new[0], MULTIPLIERS[self.kind], step)
        gradient = -new[1] @ dense(bent.first[np.newaxis])[0].reshape(size, -1)
        if len(derivatives) > 1:
            rates = np.zeros((len(derivatives[0]), 3))
            rates[:, 0] = derivatives[0, :, 0, 2]
            bends = (derivatives[1] - derivatives[2]) / (2 * SHIFT)
            inverse = np.divide(1.0, rates, out=rates, where=rates != 0).ravel()
            gradient -= value * inverse @ dense(bends[np.newaxis])[0].reshape(size, -1)
        return value, gradient, new, bent

    @cached_property
    def shifts(self) -> NDArray:
        """Shifts of z at which the legs are needed: none, and to both sides of all T."""
        shift = np.zeros(self.equations.length)
        if not self.equations.ball.lasts:
            return shift[np.newaxis]
        shift[2 : self.equations.size : 3] = SHIFT
        return np.array([0 * shift, shift, -shift])

    def solve(self, guess, normal, border, tolerance=1e-8, iterations=8) -> _Point:
        """The special orbit on the plane through a guess across a normal, by Newton's method.

        It ends with a step of the relative size `tolerance`. As its convergence is quadratic, the
        error is one of rounding after a step of 1e-8. The derivatives along v are those before the
        last step.

        Raises
        ------
        OrbitNotFound
            If it does not converge.
        """
        z = guess
        for _ in range(iterations):
            linear = self.equations.linear(z + self.shifts)
            jacobian = dense(linear.derivatives[:1])[0].reshape(-1, len(z))
            try:
                value, gradient, new, bent = self.condition(z, linear.derivatives, border)
                matrix = np.vstack([jacobian, gradient, normal])
                right = np.zeros((len(z), 2))
                right[:-2, 0] = -linear.legs[0].ravel()
                right[-2, 0] = -value
                right[-1] = normal @ (guess - z), 1.0
                step, tangent = np.linalg.solve(matrix, right).T
            except np.linalg.LinAlgError:
                break
            z = z + step
            small = np.all(np.abs(step) < tolerance * self.equations.sizes(z[np.newaxis]))
            if small and abs(value) < ZERO:
                return _Point(z, tangent, new, bent)
        raise OrbitNotFound(f"no {self.kind} is found: Newton's method does not converge")

    def tests(self, points: list[_Point], names: Iterable[str]) -> dict[str, NDArray]:
        """What is zero at the points of codimension two, by their names, shape (points,)."""
        z = np.array([point.z for point in points])
        linear = self.equations.linear(z)
        tests = {}
        for name in names:
            if name == "period halving":
                tests[name] = _difference_of_halves(self.equations, z)
            elif name in KINDS:
                tests[name] = KINDS[name].test(self.equations, z, linear)
            elif "resonance" in name:
                tests[name] = self.equations.trace_and_determinant(linear)[1] - 1
            else:
                # a or b, with the lengths of v and w.
                multiplier = MULTIPLIERS[self.kind]
                values = [
                    coefficient(each.bent, each.border[0], each.border[1], multiplier)
                    for each in points
                ]
                tests[name] = np.array(values)
        return tests

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of the points of codimension two."""
        on_the_way = {"grazing of a flight", "grazing of a release", *self.equations.watched}
        others = on_the_way - {self.kind}
        if self.kind in MULTIPLIERS:
            others = others - MULTIPLIERS.keys() | set(DEGENERATE[self.kind])
        return tuple(sorted(others))

    @cached_property
    def ends(self) -> tuple[str, ...]:
        """Those of them at which a curve ends."""
        return tuple(name for name in self.names if name in KINDS and KINDS[name].end)


def special_curve(
    special: PeriodicOrbit,
    *,
    along: tuple[str | Path, str | Path] = ("amplitude", "restitution"),
    ranges: Mapping[str, tuple[float, float]] | None = None,
    points: int = 400,
) -> SpecialCurve:
    """The curve of special orbits through one of them, in two parameters, both ways.

    Parameters
    ----------
    special : PeriodicOrbit
        A special orbit of a branch, such as ``branch.first("saddle-node")``. A period halving is a
        period doubling of half the period, and the grazing of an impact is that of a flight of the
        orbit without this impact; these are the curves that are followed.
    along : tuple of two names or paths
        As for `follow`.
    ranges : mapping of names to (low, high), optional
        Where the curve ends; by default at a tenth and at ten times the value of the start, or at
        10 if that is more, within the limits of the parameter.
    points : int
        The largest number of orbits in each direction.

    Returns
    -------
    SpecialCurve

    Raises
    ------
    OrbitNotFound
        If the orbit is no special orbit from which a curve goes on.
    ValueError
        If a parameter is unknown or the orbit is outside the ranges.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, follow, orbit
    >>> doubling = follow(orbit(Rigid(0.5), amplitude=1.4), to=1.8).first("period doubling")
    >>> curve = special_curve(doubling, ranges={"amplitude": (0.5, 3.0), "restitution": (0.1, 1.0)})
    >>> [each.kind for each in curve.special], curve.end
    (['1:2 resonance'], 'restitution = 1 is reached')
    """
    system, z = _start(special, along)
    limits = _limits(system.equations, z, special, ranges)
    border = system.border(z)
    first = system.solve(z, np.eye(len(z))[-1], border)
    if not np.abs(first.z - z).max() < OTHER * (1 + np.abs(z).max()):
        raise OrbitNotFound(f"the orbit is no {system.kind}: the nearest one is elsewhere")
    direction = first.tangent / np.linalg.norm(first.tangent)
    z, found, end = _half(system, *_march(system, first, direction, limits, points))
    start = CLOSED
    if end != CLOSED:
        back, before, start = _half(system, *_march(system, first, -direction, limits, points))
        z = np.concatenate([back[:0:-1], z])
        found = (*before[::-1], *found)
    return SpecialCurve(system.equations, z, found, start, end, system.kind)


CLOSED = "the curve is closed"
SUCH = "such as branch.first('period doubling')"


def _start(special: Any, along) -> tuple[_System, NDArray]:
    """The equations of special orbits along two parameters, and one of them."""
    allowed = KINDS.keys() - {"lost release", "vanishing flight", *OF_RESTS}
    if not isinstance(special, PeriodicOrbit):
        raise ValueError(f"special = {brief(special)}: must be a special orbit of a branch, {SUCH}")
    if not special.kind:
        raise OrbitNotFound(
            f"the orbit is an ordinary one: a curve starts at a special one, {SUCH}"
        )
    if isinstance(along, str) or np.size(along) != 2:
        raise ValueError(
            f"along = {brief(along)}: must be two names or paths, such as"
            " ('amplitude', 'restitution')"
        )
    if special.kind not in allowed:
        raise OrbitNotFound(
            f"kind = {special.kind!r}: a curve goes through a special orbit of a branch:"
            f" {', '.join(sorted(allowed))}"
        )
    paths = tuple(path_of(each, special.ball, special.table) for each in along)
    if len({path.name for path in paths}) != 2:
        raise ValueError(f"along = {along!r}: must be two different parameters")
    given = special.ball, special.impacts, special.periods, special.amplitude
    equations = OrbitEquations(*given, paths, special.table)
    here = special.ball, special.amplitude
    values = [float(place_on(path, *here, special.table)) for path in paths]
    z = np.append(special.z[: equations.size], values)
    if special.kind == "grazing of an impact":
        others, row = one_impact_less(equations, z)
        return _System(others, "grazing of a flight"), row
    if special.kind == "period halving":
        halves, rows = halves_of(equations, z[np.newaxis])
        return _System(replace(halves, periods=int(halves.periods)), "period doubling"), rows[0]
    return _System(equations, special.kind), z


def _limits(equations, z, special, ranges) -> NDArray:
    """The ends of both parameters, shape (2, 2): the least and the greatest values."""
    wanted = {} if ranges is None else ranges
    if not isinstance(wanted, Mapping) or any(np.size(each) != 2 for each in wanted.values()):
        raise ValueError(
            f"ranges = {brief(ranges)}: must be a mapping of names to (low, high), such as"
            " {'amplitude': (0.5, 3.0)}"
        )
    wanted = dict(wanted)
    ends = []
    for path, value in zip(equations.along, z[equations.size :], strict=True):
        least, greatest = path.limits(special.ball, special.amplitude)
        usual = max(least, value / 10), min(greatest, max(10.0, 10 * value))
        low, high = wanted.pop(path.name, usual)
        if not max(low, least) <= value <= min(high, greatest):
            raise ValueError(f"{path.name} = {value:.10g} is not in its range, [{low:g}, {high:g}]")
        ends.append((max(low, least), min(high, greatest)))
    if wanted:
        names = " and ".join(path.name for path in equations.along)
        raise ValueError(f"ranges: {', '.join(wanted)}: the parameters are {names}")
    return np.array(ends).T


def _march(system: _System, first: _Point, direction, limits, most: int) -> tuple[list, str]:
    """The special orbits in one direction, and why there are no more.

    The predictor is a parabola with the tangents at the last two points.
    """
    units = scales(system.equations, first.z[np.newaxis])[0]
    here = first
    ahead = direction / units / np.linalg.norm(direction / units)
    bend = np.zeros(len(units))
    length = FIRST_STEP
    points = [first]
    while len(points) < most:
        try:
            guess = here.z + length * (ahead + length * bend) * units
            point, end = _solved(system, here, guess, ahead / units, limits)
            following = point.tangent / units / np.linalg.norm(point.tangent / units)
            if not following @ ahead > STRAIGHT:
                raise OrbitNotFound("the curve turns")
            if abs(_difference_of_halves(system.equations, point.z[np.newaxis])[0]) < ZERO:
                raise OrbitNotFound("the orbit is one of half the period, taken twice")
        except OrbitNotFound:
            length /= 2
            if length < SHORTEST_STEP:
                return points, _lost(system, here)
            continue
        points.append(point)
        tests = system.tests([here, point], system.ends)
        if end or any(before * after < 0 for before, after in tests.values()):
            return points, end
        if len(points) > 4 and np.linalg.norm((point.z - first.z) / units) < length:
            return [*points, first], CLOSED
        wider = scales(system.equations, point.z[np.newaxis])[0]
        bend = (following - ahead) / (2 * length) * units / wider
        if following @ ahead > 0.99:
            length = min(1.5 * length, LONGEST_STEP)
        here = point
        units = wider
        ahead = point.tangent / units / np.linalg.norm(point.tangent / units)
    return points, "all points are used"


def _solved(system, here: _Point, guess, normal, limits) -> tuple[_Point, str]:
    """The special orbit near a guess, or at the end of a range, and then the words for this end."""
    size = system.equations.size
    paths = system.equations.along
    point = system.solve(guess, normal, here.border)
    end = ""
    old = here.z[size:]
    # A point at the end of one range may still be outside the other one.
    for _ in paths:
        values = point.z[size:]
        outside = (values < limits[0]) | (values > limits[1])
        if not outside.any():
            break
        bound = np.where(values < old, *limits)
        share = np.where(outside, (bound - old) / (values - old), np.inf)
        j = int(share.argmin())
        guess = here.z + share[j] * (point.z - here.z)
        guess[size + j] = bound[j]
        normal = np.eye(len(guess))[size + j] * np.sign(values[j] - old[j])
        point = system.solve(guess, normal, here.border)
        point.z[size + j] = bound[j]
        end = f"{paths[j].name} = {bound[j]:.10g} is reached"
    return point, end


class _Passed(NamedTuple):
    """Where a test is zero: the number of the step and the share of it, its name, and the orbit.

    The orbit is None if it is not found, or if there is none.
    """

    step: int
    share: float
    name: str
    z: NDArray | None


def _half(system: _System, points: list[_Point], end: str) -> tuple:
    """One direction of a curve, up to a point of codimension two where it ends.

    Returns the special orbits, shape (points, N), those of codimension two, and why it ends.
    """
    tests = system.tests(points, system.names)
    none = _Passed(len(points), 0.0, "", None)
    ends = [
        _located(system, name, points, i, 1.0)
        for name in system.ends
        for i in _changes(tests[name])
    ]
    last = min([*ends, none], key=lambda each: each[:2])
    found = [last]
    for name in set(system.names) - set(system.ends):
        values = tests[name]
        if "resonance" in name:
            resonant = np.abs(values) < RESONANT
            values = np.where(resonant, 0.0, values)
            if resonant[-1] and not resonant.all():
                found.append(_Passed(len(points) - 1, 0.0, name, points[-1].z))
        for i in _changes(values):
            if i <= last.step:
                upto = max(last.share - BESIDE, 0.0) if i == last.step else 1.0
                found.append(_located(system, name, points, i, upto))
    found.sort(key=lambda each: each[:2])
    special = [
        PeriodicOrbit(system.equations, each.z, each.name) for each in found if each.z is not None
    ]
    rows = [point.z for point in points[: last.step + 1]]
    if last.z is not None:
        rows.append(last.z)
    if last.name:
        end = f"{last.name}: {KINDS[last.name].end}"
    return np.array(rows), tuple(special), end or _lost(system, points[-1])


def _lost(system: _System, point: _Point) -> str:
    """Why a curve ends if none of its ends is found."""
    values = zip(system.equations.along, point.z[system.equations.size :], strict=True)
    place = ", ".join(f"{path.name} = {value:.7g}" for path, value in values)
    return f"no further {system.kind} is found beyond {place}"


def _difference_of_halves(equations: OrbitEquations, z: NDArray) -> NDArray:
    """Difference of the halves of orbits along that of the orbit before, and of the first its size.

    Its sign changes where the halves swap: there the orbits are those of half the period. It is 1
    for an odd number of impacts.
    """
    if equations.impacts % 2:
        return np.ones(len(z))
    difference = equations.halves(z)
    size = np.linalg.norm(difference, axis=1)
    along = np.sum(difference[1:] * difference[:-1], axis=1) / size[:-1]
    signs = np.cumprod([1.0, *np.sign(along)])
    return signs * [size[0], *np.abs(along)]


def _swapped(equations: OrbitEquations, z: NDArray) -> NDArray:
    """The same orbit from half a period later on."""
    halves = z[: equations.size].reshape(2, -1)
    shift = np.zeros_like(halves[0])
    shift[:: equations.unknowns] = np.pi * equations.periods
    return np.concatenate([halves[1] - shift, halves[0] + shift, z[equations.size :]])


def _changes(values: NDArray) -> NDArray:
    """The numbers of the steps in which a test changes its sign."""
    return (values[1:] * values[:-1] < 0).nonzero()[0]


def _located(system: _System, name: str, points: list[_Point], i: int, upto: float) -> _Passed:
    """Where a test is zero in the step i; at its end, without an orbit, if that is not found."""
    missing = _Passed(i, 1.0, name, None)
    here = points[i]
    chord = points[i + 1].z - here.z
    normal = chord / (chord @ chord)
    # The share is a linear function of z. The points before the step serve the predictor.
    known = {normal @ (point.z - here.z): point for point in points[max(i - 3, 0) : i]}
    known |= {0.0: here, 1.0: points[i + 1]}
    if name == "period halving":
        # Behind it the curve goes back through the same orbits, with the halves swapped.
        rows = [_swapped(system.equations, point.z) for point in points[max(i - 3, 0) : i + 1]]
        known |= {normal @ (row - here.z): here._replace(z=row) for row in rows}

    def interpolated(share):
        return KroghInterpolator(list(known), [each.z for each in known.values()])(share)

    def corrected(share):
        return system.solve(interpolated(share), normal, here.border, tolerance=1e-11)

    def at(share):
        if share in known:
            return known[share]
        # At an end the equations are singular, but the curve is smooth.
        return here._replace(z=interpolated(share)) if name in system.ends else corrected(share)

    def test(share):
        return system.tests([here, at(share)], [name])[name][1]

    try:
        # Next to a halving Newton's method finds period doublings of half the period.
        if name in system.ends and name != "period halving":
            known |= {share: corrected(share) for share in (0.25, 0.5, 0.75)}
        share = brentq(test, 0.0, upto)
        # A clearance jumps to FAR where flights or contacts no longer turn back.
        jumps = abs(test(share)) > ZERO * max(abs(test(0.0)), abs(test(upto)))
        return missing if jumps else _Passed(i, share, name, at(share).z)
    except (OrbitNotFound, ValueError):
        # The orbits cannot be continued, or the test changes its sign behind `upto`.
        return missing
