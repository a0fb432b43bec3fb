"""Three independent routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the paper's equations, the *formula* is the explicit
branch, the *simulation* runs from event to event. Every published orbit and
bifurcation is taken from its dataset and met by the two routes that it did not
come from. A disagreement beyond its budget fails the run with the orbit named.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.continuation.branch import (
    ContinuationError,
    continue_both_ways,
    continue_branch,
    solve_at,
)
from bouncing_ball.continuation.corrector import NewtonSettings, newton, plane
from bouncing_ball.continuation.events import parameter_bound, vanishing
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.datasets.variables import describe
from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.restitution_map import exact_map_jacobian
from bouncing_ball.impacts.spring_damper import Contact, Release
from bouncing_ball.motion.contacts import contact_cycle
from bouncing_ball.motion.instants import impact_cycle
from bouncing_ball.orbits import restitution_orbit as restitution
from bouncing_ball.orbits.admissibility import restitution_is_admissible
from bouncing_ball.orbits.closed_form import branch_point
from bouncing_ball.orbits.contact_orbit import ContactOrbit
from bouncing_ball.orbits.contact_system import OrbitSystem, Parameter
from bouncing_ball.orbits.limits import period_doubling, saddle_node
from bouncing_ball.orbits.monodromy import monodromy, trace_and_contraction
from bouncing_ball.orbits.projection import distance, nearest_excess
from bouncing_ball.orbits.restitution_system import RestitutionSystem
from bouncing_ball.orbits.stability import (
    is_stable,
    period_doubling_function,
    saddle_node_function,
)
from bouncing_ball.studies.orbit_branches import PERIOD_DOUBLING, SADDLE_NODE, controls

# Periods over which the simulation must hold a stable orbit.
HELD_PERIODS = 50
# Departure from an unstable orbit: small against the orbit, large against
# rounding, so that its growth over one cycle shows six digits of the multiplier.
_NUDGE = 1e-8


# Kinds of comparison and their budgets. Continuation and formula are both right
# to rounding, amplified where the branch merges with permanent contact: the
# impact velocity is 1e-4 at the end of the branches there, and rounding of the
# orbit's equations enters divided by it. One cycle of the simulation adds as
# much again; fifty add up. The departure is a difference quotient over 1e-8 of
# the impact velocity, so that rounding, 1e-15, leaves seven digits, and one or
# two fewer in the same corner.
FORMULA, CLOSES = "continuation and formula", "simulation over one cycle"
HOLDS = f"simulation over {HELD_PERIODS} cycles, stable orbits"
LEAVES = "rate of departure, unstable orbits"
BUDGETS = {FORMULA: 1e-11, CLOSES: 1e-10, HOLDS: 1e-9, LEAVES: 1e-5}


# Steps of a continuation whose points only start Newton's method at the orbits.
_LARGEST_STEP, _LARGEST_ANGLE = 0.8, 0.4
# Test function below which an orbit counts as left: away from the bifurcations,
# where the multiplier is ±1 and a departure would tell nothing.
_UNSTABLE = -0.05
BIFURCATIONS = (SADDLE_NODE, PERIOD_DOUBLING)


class WitnessError(ValueError):
    """Two routes to one orbit disagree beyond their budget."""


class Comparison(NamedTuple):
    """Disagreements of one kind, one for each orbit, and the orbits' names."""

    kind: str
    values: np.ndarray
    names: list[str]


def _names(orbit: ContactOrbit) -> list[str]:
    lam, omega = np.broadcast_arrays(orbit.amplitude, orbit.contact.frequency_ratio)
    pairs = zip(np.ravel(lam), np.ravel(omega), strict=True)
    return [f"{orbit.n}-T orbit at Λ = {x:.6g}, ϖ = {w:.6g}" for x, w in pairs]


def _rule(data: xr.Dataset) -> Release:
    return Release(data.attrs["release"])


def _flat(n: int, omega, zeta, rule, *values) -> ContactOrbit:
    arrays = [np.ravel(x) for x in np.broadcast_arrays(omega, zeta, *values)]
    there = np.isfinite(arrays[-1])
    omega, zeta, *values = (x[there] for x in arrays)
    return ContactOrbit(n, Contact(omega, zeta, rule), *values)


def sweep_orbits(data: xr.Dataset) -> ContactOrbit:
    """The orbits of a dataset along ϖ (Figs. 5, 6, 10, 13)."""
    zeta = damping_ratio(data.restitution.values)[:, np.newaxis]
    return _flat(
        int(data.attrs["n"]),
        data.frequency_ratio.values,
        zeta,
        _rule(data),
        data.amplitude.values[:, np.newaxis],
        data.phase.values,
        data.contact_duration.values,
        data.impact_velocity.values,
    )


def branch_orbits(data: xr.Dataset) -> ContactOrbit:
    """The orbits of a dataset along Λ (Figs. 8, 9, 15)."""
    return _flat(
        int(data.attrs["n"]),
        data.frequency_ratio.values[:, np.newaxis],
        float(damping_ratio(data.attrs["restitution"])),
        _rule(data),
        data.amplitude.values,
        data.phase.values,
        data.contact_duration.values,
        data.impact_velocity.values,
    )


def single_orbits(data: xr.Dataset) -> ContactOrbit:
    """The orbits of a dataset of time histories (Figs. 7 and 12)."""
    return _flat(
        int(data.attrs["n"]),
        np.asarray(data.frequency_ratio.values, dtype=float),
        float(damping_ratio(data.attrs["restitution"])),
        _rule(data),
        float(data.attrs["amplitude"]),
        data.phase.values,
        data.contact_duration.values,
        data.impact_velocity.values,
    )


def continuation_against_formula(orbit: ContactOrbit) -> Comparison:
    """Orbits from a continuation against the nearest points of the formula."""
    point = branch_point(nearest_excess(orbit), orbit.contact, orbit.n)
    return Comparison(FORMULA, distance(orbit, point), _names(orbit))


def _coarse(settings: Mapping[str, Any]) -> tuple[StepControl, NewtonSettings]:
    """Long steps: the branch is only a guess, corrected at every orbit."""
    control, newton_settings = controls(settings)
    return replace(control, largest=_LARGEST_STEP, max_angle=_LARGEST_ANGLE), newton_settings


def _continued(orbit: ContactOrbit, settings: Mapping[str, Any]) -> np.ndarray:
    """Distances of orbits along ϖ, one ζ and Λ, from a continuation in ln ϖ."""
    control, tolerance = _coarse(settings)
    omega = np.asarray(orbit.contact.frequency_ratio)
    zeta, lam = np.asarray(orbit.contact.damping_ratio).item(0), float(orbit.amplitude[0])
    rule = orbit.contact.release
    system = OrbitSystem(orbit.n, zeta, Parameter.LOG_FREQUENCY_RATIO, lam, rule)
    stiff = max(settings["stiff_frequency_ratio"], float(omega.max()))
    start = solve_at(system, system.guess(lam, stiff), tolerance)
    # A hair beyond the softest contact, so that it lies inside the branch.
    target = parameter_bound(np.log(omega.min()) - 1e-3, False, "target reached")
    branch = continue_branch(
        system,
        start,
        increasing=False,
        events=(*(event for event in system.events() if event.terminal), target),
        control=control,
        settings=tolerance,
    )
    if branch.end_reason != target.reason:
        raise ContinuationError(
            f"continuation at Λ = {lam:g} ends before ϖ = {omega.min():g}: {branch.end_reason}"
        )
    y = _at_parameter(system, branch.points, np.log(omega), tolerance)
    found = system.orbit(y)
    turn = np.angle(np.exp(1j * (orbit.phase - found.phase)))
    differences = (
        turn,
        (orbit.contact_duration - found.contact_duration) * omega,
        orbit.impact_velocity - found.impact_velocity,
    )
    return np.max(np.abs(differences), axis=0)


def _at_parameter(system, points, wanted, settings: NewtonSettings) -> np.ndarray:
    """Solutions at given parameters between the points of a monotone branch."""
    order = np.argsort(points[:, -1])
    columns = [np.interp(wanted, points[order, -1], points[order, k]) for k in range(4)]
    guess = np.stack(columns, axis=-1)
    axis = np.zeros(4)
    axis[-1] = 1.0
    patient = settings._replace(max_iterations=2 * settings.max_iterations)
    return newton(system, guess, plane(np.broadcast_to(axis, guess.shape), guess), patient).point


def formula_against_continuation(orbit: ContactOrbit, settings: Mapping[str, Any]) -> Comparison:
    """Orbits from the formula against a continuation along ϖ, curve by curve."""
    zeta, lam = np.asarray(orbit.contact.damping_ratio), orbit.amplitude
    values = np.empty(lam.shape)
    for pair in sorted(set(zip(zeta.tolist(), lam.tolist(), strict=True))):
        at = (zeta == pair[0]) & (lam == pair[1])
        values[at] = _continued(_chosen(orbit, at), settings)
    return Comparison(FORMULA, values, _names(orbit))


def bifurcations_against_formula(data: xr.Dataset) -> Comparison:
    """Located bifurcations of a dataset against those of the formula."""
    rule, n = _rule(data), int(data.attrs["n"])
    zeta = float(damping_ratio(data.attrs["restitution"]))
    values, names = [], []
    for ratio in data.frequency_ratio.values:
        row = data.sel(frequency_ratio=ratio)
        for kind, lam, phase, duration in zip(
            row.special_kind.values,
            row.special_amplitude.values,
            row.special_phase.values,
            row.special_contact_duration.values,
            strict=True,
        ):
            if kind not in (SADDLE_NODE, PERIOD_DOUBLING):
                continue
            values.append(
                _bifurcation_distance(
                    str(kind), n, Contact(ratio, zeta, rule), lam, phase, duration
                )
            )
            names.append(f"{kind} of the {n}-T orbits at Λ = {lam:.6g}, ϖ = {ratio:.6g}")
    return Comparison(FORMULA, np.array(values), names)


def _bifurcation_distance(kind, n, contact, amplitude, phase, duration) -> float:
    """Distance of a located bifurcation from that of the formula, in Λ and φ."""
    scalar = np.asarray(amplitude), np.asarray(phase), np.asarray(duration)
    excess = nearest_excess(ContactOrbit(n, contact, *scalar, np.asarray(0.0)))
    test = saddle_node_function if kind == SADDLE_NODE else period_doubling_function
    # Two secant steps from a start that is right to rounding.
    width = 1e-4 / max(contact.frequency_ratio, 1.0)
    ends = [excess - width, excess + width]
    for _ in range(6):
        points = [branch_point(e, contact, n) for e in ends]
        low, high = (test(point.trace, point.determinant) for point in points)
        if high == low:
            break
        ends = [ends[1], ends[1] - high * (ends[1] - ends[0]) / (high - low)]
    point = branch_point(ends[1], contact, n)
    turn = np.angle(np.exp(1j * (phase - point.phase)))
    return float(max(abs(amplitude - point.amplitude), abs(turn)))


def simulation_closes(orbit: ContactOrbit) -> Comparison:
    """The simulation returns to every orbit after one cycle."""
    u = orbit.relative_impact_velocity
    cycle = contact_cycle(orbit.contact, orbit.amplitude, orbit.phase, u)
    turn = np.angle(np.exp(1j * (cycle.phase - orbit.phase)))
    late = cycle.time - 2 * np.pi * orbit.n
    values = np.max(np.abs([turn, late, cycle.relative_velocity - u]), axis=0)
    return Comparison(CLOSES, values, _names(orbit))


def simulation_holds(orbit: ContactOrbit) -> Comparison:
    """The simulation stays on every stable orbit."""
    phase, u = orbit.phase, orbit.relative_impact_velocity
    start = phase, u
    for _ in range(HELD_PERIODS):
        cycle = contact_cycle(orbit.contact, orbit.amplitude, phase, u)
        phase, u = cycle.phase, cycle.relative_velocity
    turn = np.angle(np.exp(1j * (phase - start[0])))
    values = np.max(np.abs([turn, u - start[1]]), axis=0)
    return Comparison(HOLDS, np.where(np.isnan(values), np.inf, values), _names(orbit))


def simulation_leaves(orbit: ContactOrbit) -> Comparison:
    """The simulation leaves every unstable orbit at the rate of its multiplier.

    Started a little off along the unstable direction, on both sides; the
    growth of the difference over one cycle is compared with the multiplier.
    """
    multiplier, direction = _leading(monodromy(orbit))
    u = orbit.relative_impact_velocity
    # A fixed part of the impact velocity, so that soft landings are met too.
    nudge = _NUDGE * np.abs(u)[:, np.newaxis] * direction
    ends = []
    for sign in (1.0, -1.0):
        cycle = contact_cycle(
            orbit.contact,
            orbit.amplitude,
            orbit.phase + sign * nudge[:, 0],
            u + sign * nudge[:, 1],
        )
        turn = np.angle(np.exp(1j * (cycle.phase - orbit.phase)))
        ends.append(np.stack([turn, cycle.relative_velocity], axis=-1))
    return Comparison(LEAVES, _departure(ends, nudge, multiplier), _names(orbit))


def _chosen(orbit: ContactOrbit, which: np.ndarray) -> ContactOrbit:
    contact = Contact(
        np.asarray(orbit.contact.frequency_ratio)[which],
        np.asarray(orbit.contact.damping_ratio)[which],
        orbit.contact.release,
    )
    return ContactOrbit(
        orbit.n,
        contact,
        *(
            x[which]
            for x in (orbit.amplitude, orbit.phase, orbit.contact_duration, orbit.impact_velocity)
        ),
    )


def _simulated(orbit: ContactOrbit) -> Iterator[Comparison]:
    omega, zeta = orbit.contact.frequency_ratio, orbit.contact.damping_ratio
    # The simulation has no steady contact at the undamped resonance.
    orbit = _chosen(orbit, np.hypot((omega - 1) * (omega + 1), 2 * zeta * omega) > 1e-3)
    stable = is_stable(*trace_and_contraction(orbit))
    yield simulation_closes(orbit)
    yield simulation_holds(_chosen(orbit, stable))
    trace, det = trace_and_contraction(orbit)
    unstable = np.minimum(saddle_node_function(trace, det), period_doubling_function(trace, det))
    yield simulation_leaves(_chosen(orbit, unstable < _UNSTABLE))


def _table_against_formula(data: xr.Dataset) -> Comparison:
    """Table 1's bifurcations against those of the formula."""
    rule, zeta = _rule(data), float(damping_ratio(data.attrs["restitution"]))
    values, names = [], []
    for ratio in data.frequency_ratio.values:
        for n in data.n.values:
            for kind in data.bound.values:
                cell = data.sel(frequency_ratio=ratio, n=n, bound=kind)
                place = (cell.computed, cell.special_phase, cell.special_contact_duration)
                place = tuple(float(x) for x in place)
                contact = Contact(ratio, zeta, rule)
                values.append(_bifurcation_distance(str(kind), int(n), contact, *place))
                names.append(f"{kind} of the {n}-T orbits, ϖ = {ratio:g}")
    return Comparison(FORMULA, np.array(values), names)


class RestitutionOrbits(NamedTuple):
    """n-T orbits of the restitution model: n, r, Λ, φ, as flat arrays or scalars."""

    n: int
    restitution: float
    amplitude: np.ndarray
    phase: np.ndarray


def _restitution_names(orbits: RestitutionOrbits) -> list[str]:
    return [f"{orbits.n}-T orbit at Λ = {x:.6g}, restitution model" for x in orbits.amplitude]


def _restitution_families(data: xr.Dataset) -> Iterator[RestitutionOrbits]:
    r = data.attrs["restitution"]
    if "restitution_amplitude" in data:
        lam, phase = data.restitution_amplitude.values, data.restitution_phase.values
        yield RestitutionOrbits(int(data.attrs["n"]), r, lam, phase)
    elif "n" in data.dims:
        for n in data.n.values:
            family = data.sel(n=n)
            yield RestitutionOrbits(int(n), r, family.amplitude.values, family.phase.values)
    else:
        lam, phase = np.array([data.attrs["amplitude"]]), np.array([float(data.phase)])
        yield RestitutionOrbits(int(data.attrs["n"]), r, lam, phase)


def _restitution_continued(
    orbits: RestitutionOrbits, settings: Mapping[str, Any]
) -> Iterator[Comparison]:
    """Continuation of the map's fixed points, and its located bifurcations."""
    control, tolerance = _coarse(settings)
    n, r, lam, phase = orbits
    system = RestitutionSystem(n, r)
    patient = tolerance._replace(max_iterations=2 * tolerance.max_iterations)
    if r == 1:
        # φ is ±π/2 all along: solved at each Λ, from a start that is off. The
        # fold lies at Λ = 0, where φ has no meaning.
        guess = np.stack([phase + 1e-3, np.full_like(lam, n * np.pi - 1e-3), lam], axis=-1)
        axis = np.broadcast_to([0.0, 0.0, 1.0], guess.shape)
        found = newton(system, guess, plane(axis, guess), patient)
        differences = found.point[:, 0] - phase, found.point[:, 1] - n * np.pi
        yield Comparison(FORMULA, np.max(np.abs(differences), axis=0), _restitution_names(orbits))
        return
    node, doubling = restitution.saddle_node(n, r), restitution.period_doubling(n, r)
    start = float(node + doubling) / 2
    y = np.array([float(restitution.phase(n, r, start)), n * np.pi, start])
    top = max(float(lam.max()), float(doubling)) + control.largest
    branch = continue_both_ways(
        system,
        y,
        events=(*system.events(), parameter_bound(top, True, "left the window")),
        control=control,
        settings=tolerance,
    )
    # φ runs along the whole branch: the continued point at each published φ.
    guess = np.stack(
        [np.interp(phase, branch.points[:, 0], branch.points[:, k]) for k in range(3)], axis=-1
    )
    axis = np.broadcast_to([1.0, 0.0, 0.0], guess.shape)
    found = newton(system, guess, plane(axis, guess), patient)
    differences = found.point[:, 2] - lam, found.point[:, 1] - n * np.pi
    yield Comparison(FORMULA, np.max(np.abs(differences), axis=0), _restitution_names(orbits))
    names = [f"{kind} of the {n}-T orbits, restitution model" for kind in BIFURCATIONS]
    located = [branch.named(kind)[0][2] for kind in BIFURCATIONS]
    yield Comparison(FORMULA, np.abs(np.array(located) - [float(node), float(doubling)]), names)


def _restitution_simulated(orbits: RestitutionOrbits) -> Iterator[Comparison]:
    n, r, lam, phase = orbits
    there = restitution_is_admissible(n, lam, phase)
    orbits = orbits._replace(amplitude=lam[there], phase=phase[there])
    lam, phase = orbits.amplitude, orbits.phase
    names, velocity = _restitution_names(orbits), np.full_like(lam, n * np.pi)

    def off(cycle):
        turn = np.angle(np.exp(1j * (cycle.phase - phase)))
        return np.max(np.abs([turn, cycle.velocity - n * np.pi]), axis=0)

    cycle = impact_cycle(r, lam, phase, velocity)
    late = np.abs(cycle.time - 2 * np.pi * n)
    yield Comparison(CLOSES, np.maximum(off(cycle), late), names)
    trace, det = restitution.trace_and_determinant(r, lam, phase)
    stable = is_stable(trace, det)
    for _ in range(HELD_PERIODS - 1):
        cycle = impact_cycle(r, lam, cycle.phase, cycle.velocity)
    kept = [name for name, keep in zip(names, stable, strict=True) if keep]
    yield Comparison(HOLDS, off(cycle)[stable], kept)
    test = np.minimum(saddle_node_function(trace, det), period_doubling_function(trace, det))
    gone = test < _UNSTABLE
    matrix = exact_map_jacobian(2 * np.pi * n, phase, velocity, lam, r)[gone]
    multiplier, direction = _leading(matrix)
    nudge = _NUDGE * direction
    ends = []
    for sign in (1.0, -1.0):
        start = phase[gone] + sign * nudge[:, 0], velocity[gone] + sign * nudge[:, 1]
        cycle = impact_cycle(r, lam[gone], *start)
        turn = np.angle(np.exp(1j * (cycle.phase - phase[gone])))
        ends.append(np.stack([turn, cycle.velocity], axis=-1))
    left = [name for name, leaves in zip(names, gone, strict=True) if leaves]
    yield Comparison(LEAVES, _departure(ends, nudge, multiplier), left)


def _leading(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Real multiplier of larger modulus and its eigenvector, of matrices (..., 2, 2)."""
    values, vectors = np.linalg.eig(matrix)
    which = np.argmax(np.abs(values), axis=-1)[..., np.newaxis]
    value = np.take_along_axis(values, which, axis=-1)[..., 0].real
    return value, np.take_along_axis(vectors, which[..., np.newaxis, :], axis=-1)[..., 0].real


def _departure(ends, nudge, multiplier) -> np.ndarray:
    """Relative difference of the growth over one cycle from the multiplier."""
    growth = np.sum((ends[0] - ends[1]) * nudge, axis=-1) / (2 * np.sum(nudge * nudge, axis=-1))
    return np.abs(growth / multiplier - 1)


def compare_restitution(data: xr.Dataset, settings: Mapping[str, Any]) -> Iterator[Comparison]:
    """All comparisons for the restitution model's orbits of one dataset."""
    for family in _restitution_families(data):
        there = family.amplitude > 0
        orbits = family._replace(amplitude=family.amplitude[there], phase=family.phase[there])
        yield from _restitution_continued(orbits, settings)
        yield from _restitution_simulated(orbits)


def _rules_against_extended_systems(
    data: xr.Dataset, settings: Mapping[str, Any]
) -> Iterator[Comparison]:
    """Bifurcations along ϖ from the formula against the extended systems.

    The paper's equations with the test function, solved from a start that is
    a thousandth off, as the continuation locates its events.
    """
    zeta = float(data.damping_ratio)
    _, tolerance = controls(settings)
    patient = tolerance._replace(max_iterations=4 * tolerance.max_iterations)
    omega = data.frequency_ratio.values
    for rule in data.release.values:
        contact = Contact(omega, zeta, Release(str(rule)))
        for n in data.n.values:
            for kind, find in ((SADDLE_NODE, saddle_node), (PERIOD_DOUBLING, period_doubling)):
                orbit = ContactOrbit.from_branch(
                    branch_point(find(contact, n), contact, n), contact, int(n)
                )
                system = OrbitSystem(int(n), zeta, Parameter.AMPLITUDE, omega, Release(str(rule)))
                parts = (orbit.phase, orbit.impact_velocity, omega * orbit.contact_duration)
                y = np.stack([*parts, orbit.amplitude], axis=-1)
                test = next(event for event in system.events() if event.name == kind)
                found = newton(system, y * (1 + 1e-3), vanishing(test.function), patient)
                shown = data.bifurcation_amplitude.sel(release=rule, n=n, bound=kind).values
                values = np.abs(found.point[:, -1] - shown)
                names = [f"{kind} of the {n}-T orbits, {rule} release, ϖ = {w:.6g}" for w in omega]
                yield Comparison(FORMULA, values, names)


def compare(data: xr.Dataset, settings: Mapping[str, Any]) -> Iterator[Comparison]:
    """All comparisons for the spring-damper orbits of one dataset."""
    if "bifurcation_amplitude" in data:
        yield from _rules_against_extended_systems(data, settings)
        return
    if "computed" in data:
        yield _table_against_formula(data)
        return
    if "special_kind" in data:
        orbit = branch_orbits(data)
        yield continuation_against_formula(orbit)
        yield bifurcations_against_formula(data)
    else:
        orbit = sweep_orbits(data) if "case" in data.dims else single_orbits(data)
        yield formula_against_continuation(orbit, settings)
    yield from _simulated(orbit)
    if "restitution_amplitude" in data:
        yield from compare_restitution(data, settings)


def _worst(comparisons: list[Comparison], kind: str) -> tuple[float, int, str]:
    """Largest disagreement of a kind, how many were compared, and which it is."""
    same = [c for c in comparisons if c.kind == kind and len(c.values)]
    if not same:
        return np.nan, 0, ""
    values = np.concatenate([c.values for c in same])
    names = [name for c in same for name in c.names]
    worst = int(np.argmax(np.where(np.isnan(values), np.inf, values)))
    return float(values[worst]), len(values), names[worst]


def witness(datasets: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Largest disagreement of every kind for every figure and table.

    Raises
    ------
    WitnessError
        If a disagreement exceeds its budget, with the orbit named.
    """
    kinds = list(BUDGETS)
    shape = (len(datasets), len(kinds))
    largest, count, place = np.empty(shape), np.zeros(shape, dtype=int), np.empty(shape, object)
    for i, (name, data) in enumerate(datasets.items()):
        contact = "release" in data.attrs or "release" in data.dims
        routes = compare if contact else compare_restitution
        comparisons = list(routes(data, settings))
        for j, kind in enumerate(kinds):
            largest[i, j], count[i, j], place[i, j] = _worst(comparisons, kind)
            if count[i, j] and not largest[i, j] <= BUDGETS[kind]:
                raise WitnessError(
                    f"{name}: {kind} disagree by {largest[i, j]:.1e}, more than "
                    f"{BUDGETS[kind]:.0e}, at the {place[i, j]}"
                )
    dims = ("artifact", "comparison")
    return describe(
        xr.Dataset(
            {
                "disagreement": (dims, largest),
                "orbits": (dims, count),
                "worst": (dims, place.astype(str)),
                "budget": ("comparison", np.array(list(BUDGETS.values()))),
            },
            coords={"artifact": list(datasets), "comparison": kinds},
        )
    )
