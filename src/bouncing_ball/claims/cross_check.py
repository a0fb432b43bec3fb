"""Three independent routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the model's equations, the *formula* is the closed form of
its branch, the *simulation* runs from event to event. Every published orbit and
bifurcation is taken from its dataset and met by the routes that it did not come
from, as far as its model has them. A disagreement beyond its budget fails the
run with the orbit named.

What does not exist is not compared: entries that are NaN, and in the simulation
orbits that are inadmissible by the dataset *and* on their own path.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.claims import published
from bouncing_ball.claims.published import Shown, ShownLimits
from bouncing_ball.continuation.branch import ContinuationError, continue_both_ways
from bouncing_ball.continuation.corrector import Condition, NewtonSettings, newton, plane
from bouncing_ball.continuation.events import LocationError, parameter_bound, vanishing
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.datasets.variables import described
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.orbits.model import ImpactModel, Route, System
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.studies.continuation import Continuation, controls, followed_from_stiff

# Periods over which the simulation must hold a stable orbit.
HELD_PERIODS = 50
# Departure from an unstable orbit: small against the orbit, large against
# rounding, so that its growth over one cycle shows six digits of the multiplier.
_NUDGE = 1e-8

# Kinds of comparison and their budgets, relative to the larger of Λ and n.
# Continuation and formula are both right to rounding, amplified where the branch
# merges with permanent contact: the impact velocity is 1e-4 at the end of the
# branches there, and rounding of the orbit's equations enters divided by it. One
# cycle of the simulation adds as much again; fifty add up. The departure is a
# difference quotient over 1e-8 of the impact velocity, so that rounding, 1e-15,
# leaves seven digits, and one or two fewer in the same corner.
FORMULA, CLOSES = "continuation and formula", "simulation over one cycle"
HOLDS = f"simulation over {HELD_PERIODS} cycles, stable orbits"
LEAVES = "rate of departure, unstable orbits"
BUDGETS = {FORMULA: 1e-11, CLOSES: 1e-10, HOLDS: 1e-9, LEAVES: 1e-5}

# Steps of a continuation whose points only start Newton's method at the orbits.
_LARGEST_STEP, _LARGEST_ANGLE = 0.8, 0.4
# Where no continuation leads, Newton's method starts this far off, relatively:
# far against the budget, and near enough for orbits close to a fold or grazing.
_STARTS = (1e-3, 1e-5, 1e-7)
# Test function below which an orbit counts as left: away from the bifurcations,
# where the multiplier is ±1 and a departure would show nothing.
_UNSTABLE = -0.05
# Samples of an orbit's path for each half period of the contact and the table.
_SAMPLES = 64


class CrossCheckError(ValueError):
    """Two routes to one orbit disagree beyond their budget."""


class Disagreements(NamedTuple):
    """Disagreements of one kind, one for each orbit, and what the orbits are called."""

    kind: str
    values: np.ndarray
    name: Callable[[int], str]


def _size(n, amplitude) -> np.ndarray:
    """What differences of orbits are relative to: the larger of Λ and n."""
    return np.maximum(amplitude, n)


# Newton's method on a model's equations.


def _solve(
    system_of: Callable[[np.ndarray], System],
    guess: np.ndarray,
    condition_of: Callable[[System, np.ndarray], Condition],
    settings: NewtonSettings,
) -> np.ndarray:
    """Solutions from many guesses, NaN where the iteration fails."""
    every = np.arange(len(guess))
    system = system_of(every)
    with np.errstate(all="ignore"):
        found = newton(system, guess, condition_of(system, every), settings)
    # At the limit of rounding the last step never gets short enough.
    good = found.converged | (found.residual < BUDGETS[FORMULA])
    return np.where(good[:, np.newaxis], found.point, np.nan)


def _equations(model: ImpactModel, n: np.ndarray, which: np.ndarray) -> System:
    return model[which].system(n[which])


def _plane(normal: np.ndarray, through: np.ndarray, _: System, which: np.ndarray) -> Condition:
    return plane(normal[which], through[which])


def _vanishing(kind: str, system: System, _: np.ndarray) -> Condition:
    return vanishing(next(event.function for event in system.events() if event.name == kind))


def _normals(system: System, y: np.ndarray) -> np.ndarray:
    """Unit tangents of the branches through y: normals of the planes solved in."""
    return np.linalg.svd(system.jacobian(y))[2][..., -1, :]


def _coarse(settings: Continuation) -> tuple[StepControl, NewtonSettings]:
    """Long steps: the branch is only a guess, corrected at every orbit."""
    control, newton_settings = controls(settings)
    return replace(control, largest=_LARGEST_STEP, max_angle=_LARGEST_ANGLE), newton_settings


def _interpolated(vertices: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The nearest points of a polygon, of segments next to the nearest vertex."""
    nearest = np.empty(len(y), dtype=int)
    for k, point in enumerate(y):
        nearest[k] = np.argmin(np.sum((vertices - point) ** 2, axis=1))
    best, least = vertices[nearest], np.full(len(y), np.inf)
    for other in (np.maximum(nearest - 1, 0), np.minimum(nearest + 1, len(vertices) - 1)):
        chord = vertices[other] - vertices[nearest]
        square = np.sum(chord * chord, axis=1)
        along = np.sum((y - vertices[nearest]) * chord, axis=1) / np.where(square > 0, square, 1)
        point = vertices[nearest] + np.clip(along, 0, 1)[:, np.newaxis] * chord
        off = np.sum((y - point) ** 2, axis=1)
        closer = off < least
        best, least = np.where(closer[:, np.newaxis], point, best), np.where(closer, off, least)
    return best


def _along_amplitude(shown: Shown, y: np.ndarray, settings) -> np.ndarray:
    """Guesses on the continued branch along Λ of a single model."""
    model, n = shown.model[0], int(shown.orbit.n)
    control, tolerance = _coarse(settings)
    node, doubling = (float(x.amplitude) for x in (model.saddle_node(n), model.period_doubling(n)))
    if not 0 < node < doubling:
        return np.full_like(y, np.nan)
    system = model.system(n)
    top = max(float(np.max(shown.orbit.amplitude)), doubling) + control.largest
    branch = continue_both_ways(
        system,
        system.point(model.orbit(n, (node + doubling) / 2)),
        events=(
            *(event for event in system.events() if event.terminal),
            parameter_bound(top, True, "left the window"),
        ),
        control=control,
        settings=tolerance,
    )
    return _interpolated(branch.points, y)


def _along_frequency_ratio(shown: Shown, y: np.ndarray, settings) -> np.ndarray:
    """Guesses on the branches along ϖ at fixed ζ and Λ; NaN where they do not lead."""
    control, tolerance = _coarse(settings)
    orbit, guess = shown.orbit, np.full_like(y, np.nan)
    omega, zeta, lam = np.broadcast_arrays(
        orbit.law.frequency_ratio, orbit.law.damping_ratio, orbit.amplitude
    )
    for pair in sorted(set(zip(zeta.tolist(), lam.tolist(), strict=True))):
        at = np.flatnonzero((zeta == pair[0]) & (lam == pair[1]))
        softest = orbit.law[at[np.argmin(omega[at])]]
        stiff = max(settings.stiff_frequency_ratio, float(omega[at].max()))
        # A hair beyond the softest contact, so that it lies inside the branch.
        softer = replace(softest, frequency_ratio=float(softest.frequency_ratio) * (1 - 1e-3))
        try:
            branch = followed_from_stiff(int(orbit.n), softer, pair[1], stiff, control, tolerance)
        except (ContinuationError, LocationError, NoOrbitError):
            continue
        points = branch.points[::-1]
        wanted = np.log(omega[at])
        columns = [np.interp(wanted, points[:, -1], points[:, k], left=np.nan) for k in range(3)]
        guess[at] = np.stack([*columns, lam[at]], axis=-1)
    return guess


def _guesses(shown: Shown, y: np.ndarray, settings) -> Iterator[np.ndarray]:
    """Where Newton's method starts: on a continued branch, then a little off."""
    try:
        if shown.model.softens:
            yield _along_frequency_ratio(shown, y, settings)
        else:
            yield _along_amplitude(shown, y, settings)
    except (ContinuationError, LocationError):
        pass
    for share in _STARTS:
        yield y * (1 + share)


def _rounding(system: System, n: int, y: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """How far rounding of the equations can move their solutions in the planes of y.

    Skeel's condition, ε |B⁻¹| (|J| |y| + 2π²n²), B being the Jacobian J with the normal
    as its last row, and 2π²n² the fall in n periods, whose terms cancel in a flight;
    the largest over the unknowns.
    """
    jacobian = system.jacobian(y)
    bordered = np.concatenate([jacobian, normals[..., np.newaxis, :]], axis=-2)
    terms = np.einsum("...ij,...j->...i", np.abs(jacobian), np.abs(y)) + 2 * (np.pi * n) ** 2
    inverse = np.abs(np.linalg.pinv(bordered))[..., :-1]
    moved = np.einsum("...ij,...j->...i", inverse, terms)
    return np.finfo(float).eps * np.max(moved, axis=-1)


def formula_against_continuation(shown: Shown, settings: Continuation) -> Disagreements:
    """Orbits of the formula against solutions of the equations.

    Each in the plane through the orbit that is normal to its branch: well
    conditioned at a fold too, where Λ alone has half of the digits. An elastic ball
    on a table that hardly moves has its phase to fewer digits than the budget asks:
    where rounding alone can move an orbit further, that is its budget.
    """
    orbit, n = shown.orbit, int(shown.orbit.n)
    _, tolerance = controls(settings)
    patient = tolerance._replace(max_iterations=2 * tolerance.max_iterations)
    whole = shown.model.system(n)
    y = whole.point(orbit)
    normal, size = _normals(whole, y), _size(n, orbit.amplitude)
    known = np.fmax(_rounding(whole, n, y, normal) / size / BUDGETS[FORMULA], 1.0)
    best = np.full(orbit.shape, np.inf)
    for guess in _guesses(shown, y, settings):
        todo = np.flatnonzero(~(best <= BUDGETS[FORMULA]) & np.isfinite(guess).all(axis=-1))
        if not todo.size:
            continue
        part = shown.chosen(todo)
        found = _solve(
            partial(_equations, part.model, np.full(todo.shape, n)),
            guess[todo],
            partial(_plane, normal[todo], y[todo]),
            patient,
        )
        off = part.orbit.distance(part.model.system(n).orbit(found)) / size[todo]
        best[todo] = np.fmin(best[todo], off / known[todo])
    return Disagreements(FORMULA, best, shown.name)


def continuation_against_formula(shown: Shown) -> Disagreements:
    """Orbits of a continuation against the nearest points of the formula."""
    off = shown.orbit.distance(shown.model.nearest(shown.orbit))
    return Disagreements(FORMULA, off / _size(shown.orbit.n, shown.orbit.amplitude), shown.name)


# Bifurcations.


def _test_function(kind: str, orbit: Orbit) -> np.ndarray:
    return Bifurcation(kind).test(*orbit.trace_and_determinant())


def _limit_of(model: ImpactModel, kind: str, n) -> Orbit:
    return model.saddle_node(n) if kind == Bifurcation.SADDLE_NODE else model.period_doubling(n)


def _limits_off(limits: ShownLimits, orbit: Orbit) -> np.ndarray:
    """Largest difference in Λ and, where it is known, φ."""
    turn = np.abs(reduce_angle(limits.phase - orbit.phase))
    off = np.fmax(np.abs(limits.amplitude - orbit.amplitude), turn)
    return off / _size(limits.n, limits.amplitude)


def located_against_formula(limits: ShownLimits) -> Disagreements:
    """Located bifurcations against those of the formula.

    The formula gives the first one next to the saddle-node. Others of the same
    kind are the zeros of its test function: secant steps along the closed form,
    from both sides of the nearest orbit.
    """
    model, n = limits.model, limits.n
    values = _limits_off(limits, _limit_of(model, limits.kind, n))
    shown = model.orbit_of(n, limits.amplitude, limits.phase, limits.contact_duration, 0 * n)
    start = model.nearest(shown)
    system = model.system(n)
    y = system.point(start)
    along = _normals(system, y)
    width = 1e-4 / np.maximum(start.clock, 1.0)

    def orbit_at(place):
        return model.nearest(system.orbit(y + place[:, np.newaxis] * along))

    left, right = -width, +width
    with np.errstate(all="ignore"):
        low, high = (_test_function(limits.kind, orbit_at(x)) for x in (left, right))
        for _ in range(6):
            flat = high == low
            step = np.where(flat, 0, high * (right - left) / np.where(flat, 1, high - low))
            left, low, right = right, high, right - step
            high = _test_function(limits.kind, orbit_at(right))
        values = np.fmin(values, _limits_off(limits, orbit_at(right)))
    return Disagreements(FORMULA, values, limits.name)


def formula_against_equations(limits: ShownLimits, settings: Continuation) -> Disagreements:
    """Bifurcations of the formula against the extended systems.

    The model's equations with the test function, solved from a start that is a
    little off, as a continuation locates its events.
    """
    _, tolerance = controls(settings)
    patient = tolerance._replace(max_iterations=4 * tolerance.max_iterations)
    model, n = limits.model, limits.n
    y = model.system(n).point(_limit_of(model, limits.kind, n))
    best = np.full(len(n), np.inf)
    for share in _STARTS:
        todo = np.flatnonzero(~(best <= BUDGETS[FORMULA]))
        if not todo.size:
            break
        part = limits.chosen(todo)
        found = _solve(
            partial(_equations, part.model, part.n),
            y[todo] * (1 + share),
            partial(_vanishing, limits.kind),
            patient,
        )
        off = _limits_off(part, part.model.system(part.n).orbit(found))
        best[todo] = np.fmin(best[todo], off)
    return Disagreements(FORMULA, best, limits.name)


# Simulation.


def _bump(values: np.ndarray) -> np.ndarray:
    """Largest interior maximum of samples along the first axis, by parabolas."""
    before, middle, after = values[:-2], values[1:-1], values[2:]
    bend = before - 2 * middle + after
    top = np.where(
        bend < 0, middle - (after - before) ** 2 / (8 * np.where(bend < 0, bend, 1)), middle
    )
    peak = (middle >= before) & (middle >= after)
    return np.max(np.where(peak, top, -np.inf), axis=0)


def path_is_free(orbit: Orbit) -> np.ndarray:
    """Whether an orbit's own path has neither an earlier release nor a landing.

    From samples of its path, without the simulation: the ball closes in at the
    impact, is held until the release, leaves, and stays above the table.
    """
    longest = np.max(np.abs(orbit.clock * orbit.contact_duration), initial=0.0)
    count = int(_SAMPLES * (2 + longest / np.pi + np.max(orbit.n, initial=1) * 2))
    share = np.linspace(0.0, 1.0, count)[:, np.newaxis]
    held = orbit.holding(share * orbit.contact_duration)
    time = orbit.contact_duration + share * orbit.flight_time
    table = orbit.amplitude * np.sin(orbit.phase + time)
    gap = orbit.flight_path(time)[0] - table
    approach = (orbit.relative_impact_velocity < 0) & (orbit.relative_bounce_velocity > 0)
    return approach & ~(_bump(held) > 0) & ~(_bump(-gap) > 0)


def _differences(orbit: Orbit, cycle, *, late: bool) -> np.ndarray:
    """Largest difference in φ, δ′ and, over one cycle, time."""
    parts = [
        reduce_angle(cycle.phase - orbit.phase),
        cycle.relative_velocity - orbit.relative_impact_velocity,
    ]
    if late:
        parts.append(cycle.time - 2 * np.pi * np.asarray(orbit.n))
    values = np.max(np.abs(parts), axis=0) / _size(orbit.n, orbit.amplitude)
    return np.where(np.isnan(values), np.inf, values)


def simulation_closes(shown: Shown) -> Disagreements:
    """The simulation returns to every orbit after one cycle."""
    orbit = shown.orbit
    cycle = orbit.cycle(orbit.phase, orbit.relative_impact_velocity)
    return Disagreements(CLOSES, _differences(orbit, cycle, late=True), shown.name)


def simulation_holds(shown: Shown) -> Disagreements:
    """The simulation stays on every stable orbit."""
    orbit = shown.orbit
    cycle = orbit.cycle(orbit.phase, orbit.relative_impact_velocity)
    for _ in range(HELD_PERIODS - 1):
        cycle = orbit.cycle(cycle.phase, cycle.relative_velocity)
    return Disagreements(HOLDS, _differences(orbit, cycle, late=False), shown.name)


def simulation_leaves(shown: Shown) -> Disagreements:
    """The simulation leaves every unstable orbit at the rate of its multiplier.

    Started a little off along the unstable direction, on both sides; the
    growth of the difference over one cycle is compared with the multiplier.
    """
    orbit = shown.orbit
    multiplier, direction = _leading(orbit.monodromy())
    u = orbit.relative_impact_velocity
    # A fixed part of the impact velocity, so that soft landings are met too.
    nudge = _NUDGE * np.abs(u)[:, np.newaxis] * direction
    ends = []
    for sign in (1.0, -1.0):
        cycle = orbit.cycle(orbit.phase + sign * nudge[:, 0], u + sign * nudge[:, 1])
        turn = reduce_angle(cycle.phase - orbit.phase)
        ends.append(np.stack([turn, cycle.relative_velocity], axis=-1))
    growth = np.sum((ends[0] - ends[1]) * nudge, axis=-1) / (2 * np.sum(nudge * nudge, axis=-1))
    return Disagreements(LEAVES, np.abs(growth / multiplier - 1), shown.name)


def _leading(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Real multiplier of larger modulus and its eigenvector, of matrices (..., 2, 2)."""
    values, vectors = np.linalg.eig(matrix)
    which = np.argmax(np.abs(values), axis=-1)[..., np.newaxis]
    value = np.take_along_axis(values, which, axis=-1)[..., 0].real
    return value, np.take_along_axis(vectors, which[..., np.newaxis, :], axis=-1)[..., 0].real


def _simulated(shown: Shown) -> Iterator[Disagreements]:
    """The simulation of every orbit that is one of the ball."""
    shown = shown.chosen(shown.orbit.can_be_simulated())
    compared = shown.admissible.copy()
    if not compared.all():
        compared[~compared] = path_is_free(shown.orbit[~compared])
    shown = shown.chosen(compared)
    yield simulation_closes(shown)
    yield simulation_holds(shown.chosen(shown.orbit.is_stable()))
    tests = [_test_function(kind, shown.orbit) for kind in Bifurcation]
    yield simulation_leaves(shown.chosen(np.min(tests, axis=0) < _UNSTABLE))


# The table.


def compare(data: xr.Dataset, settings: Continuation) -> Iterator[Disagreements]:
    """All comparisons for the orbits and bifurcations of one dataset.

    By the routes that a model has besides the one its orbits were made by.
    """
    for shown in published.orbits(data):
        routes = shown.model.routes - {shown.made}
        if not shown.orbit.size:
            continue
        if Route.FORMULA in routes:
            yield continuation_against_formula(shown)
        if Route.CONTINUATION in routes:
            yield formula_against_continuation(shown, settings)
        if Route.SIMULATION in routes:
            yield from _simulated(shown)
    for limits in published.limits(data):
        routes = limits.model.routes - {limits.made}
        if limits.amplitude.size and Route.FORMULA in routes:
            yield located_against_formula(limits)
        elif limits.amplitude.size and Route.CONTINUATION in routes:
            yield formula_against_equations(limits, settings)


def _worst(comparisons: list[Disagreements], kind: str) -> tuple[float, int, str]:
    """Largest disagreement of a kind, how many were compared, and which it is."""
    largest, count, where = -np.inf, 0, ""
    for one in comparisons:
        if one.kind != kind or not len(one.values):
            continue
        values = np.where(np.isnan(one.values), np.inf, one.values)
        at = int(np.argmax(values))
        count += len(values)
        if values[at] > largest:
            largest, where = float(values[at]), one.name(at)
    return (largest if count else np.nan), count, where


def cross_check(data: Mapping[str, xr.Dataset], continuation: Continuation) -> xr.Dataset:
    """Largest disagreement of every kind for every figure and table that shows an orbit.

    Raises
    ------
    CrossCheckError
        If a disagreement exceeds its budget, with the orbit named.
    """
    kinds = list(BUDGETS)
    largest: dict[str, list[float]] = {}
    count: dict[str, list[int]] = {}
    for name, dataset in data.items():
        comparisons = list(compare(dataset, continuation))
        if not any(one.values.size for one in comparisons):
            continue
        worst = [_worst(comparisons, kind) for kind in kinds]
        for kind, (value, orbits, place) in zip(kinds, worst, strict=True):
            if orbits and not value <= BUDGETS[kind]:
                raise CrossCheckError(
                    f"{name}: {kind} disagree by {value:.1e}, more than "
                    f"{BUDGETS[kind]:.0e}, at the {place}"
                )
        largest[name] = [value for value, _, _ in worst]
        count[name] = [orbits for _, orbits, _ in worst]
    dims, shape = ("artifact", "comparison"), (len(largest), len(kinds))
    return described(
        {
            "disagreement": (dims, np.reshape(list(largest.values()), shape)),
            "orbits": (dims, np.reshape(list(count.values()), shape).astype(int)),
            "budget": ("comparison", np.array(list(BUDGETS.values()))),
        },
        coords={"artifact": list(largest), "comparison": kinds},
    )
