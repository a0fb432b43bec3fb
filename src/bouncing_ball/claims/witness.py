"""Three independent routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the model's equations, the *formula* is the closed form of its
branch, the *simulation* runs from event to event. Every published orbit and bifurcation
is taken from its dataset and met by the routes that it did not come from.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.continuation.corrector import Condition, NewtonSettings, newton, plane
from bouncing_ball.continuation.events import vanishing
from bouncing_ball.datasets.variables import described
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.orbits.model import ImpactModel, Route
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.orbits.system import OrbitSystem

# Periods over which the simulation must hold a stable orbit.
HELD_PERIODS = 50
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

_NUDGE = 1e-8
# Test function below which an orbit counts as left: away from the bifurcations,
# where the multiplier is ±1 and a departure would show nothing.
_UNSTABLE = -0.05
_NEWTON = NewtonSettings(max_iterations=20)
# Distance along the branch over which a test function is differentiated.
_WIDTH = 1e-4


class CrossCheckError(ValueError):
    """Two routes to one orbit disagree beyond their budget, or nothing is compared."""


class Shown(NamedTuple):
    """Orbits of one model in a row, as a dataset shows them.

    ``made`` is the route that they come from. For a ``bifurcation`` what the dataset does
    not show is NaN. ``admissible`` is what the dataset says of each orbit.
    """

    model: ImpactModel
    orbit: Any
    made: Route
    bifurcation: Bifurcation | None = None
    admissible: np.ndarray | None = None

    def name(self, k: int) -> str:
        """What an orbit is called in messages."""
        n, model = np.broadcast_to(self.orbit.n, self.orbit.shape)[k], self.model[k]
        where = f"Λ = {self.orbit.amplitude[k]:.6g}, {model.label}, {model.name} model"
        return f"{self.bifurcation or 'orbit'} of the {n}-T family at {where}"


# The orbits of a dataset.


def _row(data: xr.Dataset, *names: str) -> Iterator[np.ndarray]:
    """Variables, or parameters, in one row each, without the NaN entries of the first."""
    columns = [data[x] if x in data else xr.DataArray(data.attrs[x]) for x in names]
    flat = [column.values.ravel() for column in xr.broadcast(*columns)]
    there = np.isfinite(flat[0])
    return (column[there] for column in flat)


def _contacts(data: xr.Dataset, restitution: Any, omega: np.ndarray) -> SpringDamperModel:
    law = SpringDamper.from_restitution(restitution, omega, data.attrs["release"])
    return SpringDamperModel(law)


def contact_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the spring-damper model along Λ or ϖ."""
    data = data.assign(admissible=data.get("admissible", xr.DataArray(True)))
    names = ("contact_duration", "phase", "impact_velocity", "amplitude", "restitution")
    row = _row(data, *names, "frequency_ratio", "n", "admissible")
    duration, phase, velocity, lam, r, omega, n, admissible = row
    model = _contacts(data, r, omega)
    made = Route.CONTINUATION if "special_kind" in data else Route.FORMULA
    orbit = model.orbit_of(n, lam, phase, duration, velocity)
    yield Shown(model, orbit, made, admissible=admissible.astype(bool))


def restitution_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the restitution model, and both bifurcations of each family."""
    beside = "restitution_amplitude" in data
    names = [("restitution_" if beside else "") + x for x in ("phase", "amplitude", "admissible")]
    data = data.assign({names[2]: data.get(names[2], xr.DataArray(True))})
    phase, lam, n, admissible = _row(data, names[0], names[1], "n", names[2])
    model = RestitutionModel(np.full(len(n), data.attrs["restitution"]))
    orbit = model.orbit_of(n, lam, phase)
    yield Shown(model, orbit, Route.FORMULA, admissible=admissible.astype(bool))
    families = np.unique(n)
    model = RestitutionModel(np.full(len(families), data.attrs["restitution"]))
    for kind in Bifurcation:
        name = kind.replace("-", "_").replace(" ", "_")
        limit = getattr(model, name)(families)
        if f"{name}_amplitude" in data:
            shown = data[[f"{name}_amplitude", f"{name}_phase"]]
            shown = shown.sel(impact_map="exact") if "impact_map" in shown.dims else shown
            limit = model.orbit_of(families, *(np.atleast_1d(shown[x].values) for x in shown))
        yield Shown(model, limit, Route.FORMULA, kind)


def located(data: xr.Dataset) -> Iterator[Shown]:
    """Bifurcations that a continuation located: along branches, or in Table 1."""
    for kind in Bifurcation:
        if "special_kind" in data:
            part = data.assign(place=data.special_amplitude.where(data.special_kind == kind))
        else:
            part = data.sel(bound=kind).rename(computed="place")
        names = ("place", "frequency_ratio", "n", "special_phase", "special_contact_duration")
        lam, omega, n, phase, duration = _row(part, *names)
        model = _contacts(data, data.attrs["restitution"], omega)
        yield Shown(model, model.orbit_of(n, lam, phase, duration), Route.CONTINUATION, kind)


def along_frequency_ratio(data: xr.Dataset) -> Iterator[Shown]:
    """Bifurcations of the formula, under each rule that ends a contact."""
    for rule in data.release.values:
        for kind in Bifurcation:
            part = data.sel(release=rule, bound=kind)
            lam, omega, n = _row(part, "bifurcation_amplitude", "frequency_ratio", "n")
            model = SpringDamperModel(SpringDamper(omega, float(data.damping_ratio), Release(rule)))
            orbit = model.orbit_of(n, lam, np.full_like(lam, np.nan))
            yield Shown(model, orbit, Route.FORMULA, kind)


# What each dataset shows.
SHOWN: dict[str, tuple[Callable[[xr.Dataset], Iterator[Shown]], ...]] = {
    **{name: (restitution_orbits,) for name in ("fig02", "fig03")},
    **{f"fig{k:02d}": (contact_orbits,) for k in (5, 6, 7)},
    **{name: (contact_orbits, located) for name in ("fig08", "fig09")},
    **{f"fig{k}": (contact_orbits,) for k in (10, 12, 13, 14)},
    "fig15": (contact_orbits, restitution_orbits, located),
    "table1": (located,),
    "ext_release": (along_frequency_ratio,),
}


# The comparisons.


def _size(orbit: Orbit) -> np.ndarray:
    """What differences of orbits are relative to: the larger of Λ and n."""
    return np.maximum(orbit.amplitude, orbit.n)


def _tangents(system: OrbitSystem, y: np.ndarray) -> np.ndarray:
    """Unit tangents of the branches through y; any where y is not a number."""
    jacobian = system.jacobian(y)
    known = np.where(np.isfinite(jacobian), jacobian, 0.0)
    return np.linalg.svd(known)[2][..., -1, :]


def _solved(system: OrbitSystem, y: np.ndarray, condition: Condition) -> Any:
    """The orbits to which Newton's method moves the points y; NaN where it fails."""
    with np.errstate(all="ignore"):
        found = newton(system, y, condition, _NEWTON)
    # At the limit of rounding the last step never gets short enough.
    good = found.converged | (found.residual < BUDGETS[FORMULA])
    return system.orbit(np.where(good[:, np.newaxis], found.point, np.nan))


def orbits_against_equations(shown: Shown) -> np.ndarray:
    """Orbits of the formula against the solutions of the equations next to them.

    Each in the plane through the orbit that is normal to its branch: well conditioned at a
    fold too, where Λ alone has half of the digits.
    """
    system = shown.model.system(shown.orbit.n)
    y = system.point(shown.orbit)
    found = _solved(system, y, plane(_tangents(system, y), y))
    return shown.orbit.distance(found) / _size(shown.orbit)


def orbits_against_formula(shown: Shown) -> np.ndarray:
    """Orbits of a continuation against the nearest points of the formula."""
    return shown.orbit.distance(shown.model.nearest(shown.orbit)) / _size(shown.orbit)


def limits_against_equations(shown: Shown) -> np.ndarray:
    """Bifurcations of the formula against the equations with the test function added."""
    kind, system = shown.bifurcation, shown.model.system(shown.orbit.n)
    name = "saddle_node" if kind is Bifurcation.SADDLE_NODE else "period_doubling"
    start = getattr(shown.model, name)(shown.orbit.n)
    test = next(event.function for event in system.events() if event.name == kind)
    found = _solved(system, system.point(start), vanishing(test))
    turn = np.abs(reduce_angle(shown.orbit.phase - found.phase))
    return np.fmax(np.abs(shown.orbit.amplitude - found.amplitude), turn) / _size(shown.orbit)


def limits_against_formula(shown: Shown) -> np.ndarray:
    """Located bifurcations against the nearest zero of the test function on the formula.

    The distance from the formula's branch, and along it the test function over its slope.
    """
    orbit, model, system = shown.orbit, shown.model, shown.model.system(shown.orbit.n)
    test = Bifurcation(str(shown.bifurcation)).test
    start = model.nearest(orbit)
    y = system.point(start)
    step = _WIDTH / np.maximum(start.clock, 1.0)
    along = step[:, np.newaxis] * _tangents(system, y)
    low, middle, high = (
        test(*model.nearest(at).trace_and_determinant())
        for at in (system.orbit(y - along), start, system.orbit(y + along))
    )
    off = np.abs(2 * middle / (high - low)) * step
    turn = np.abs(reduce_angle(orbit.phase - start.phase))
    apart = np.maximum(np.abs(orbit.amplitude - start.amplitude), turn)
    return np.maximum(apart, off) / _size(orbit)


# The route that a dataset did not take, by the one that it took, for orbits and bifurcations.
_OTHER_ROUTE = {
    (Route.FORMULA, False): orbits_against_equations,
    (Route.CONTINUATION, False): orbits_against_formula,
    (Route.FORMULA, True): limits_against_equations,
    (Route.CONTINUATION, True): limits_against_formula,
}


def _differences(orbit: Orbit, cycle, *, late: bool) -> np.ndarray:
    """Largest difference in φ, δ′ and, over one cycle, time."""
    parts = [
        reduce_angle(cycle.phase - orbit.phase),
        cycle.relative_velocity - orbit.relative_impact_velocity,
    ]
    if late:
        parts.append(cycle.time - 2 * np.pi * np.asarray(orbit.n))
    return np.max(np.abs(parts), axis=0) / _size(orbit)


def simulation_closes(orbit: Orbit) -> np.ndarray:
    """How far the simulation is from every orbit after one cycle."""
    cycle = orbit.cycle(orbit.phase, orbit.relative_impact_velocity)
    return _differences(orbit, cycle, late=True)


def simulation_holds(orbit: Orbit) -> np.ndarray:
    """How far the simulation is from every stable orbit after many cycles."""
    cycle = orbit.cycle(orbit.phase, orbit.relative_impact_velocity)
    for _ in range(HELD_PERIODS - 1):
        cycle = orbit.cycle(cycle.phase, cycle.relative_velocity)
    return _differences(orbit, cycle, late=False)


def simulation_leaves(orbit: Orbit) -> np.ndarray:
    """The rate at which the simulation leaves every unstable orbit, against its multiplier.

    Started a little off along the unstable direction, on both sides.
    """
    values, vectors = np.linalg.eig(orbit.monodromy())
    which = np.argmax(np.abs(values), axis=-1)[..., np.newaxis]
    multiplier = np.take_along_axis(values, which, axis=-1)[..., 0].real
    direction = np.take_along_axis(vectors, which[..., np.newaxis, :], axis=-1)[..., 0].real
    u = orbit.relative_impact_velocity
    # A fixed part of the impact velocity, so that soft landings are met too.
    nudge = _NUDGE * np.abs(u)[:, np.newaxis] * direction
    ends = []
    for sign in (1.0, -1.0):
        cycle = orbit.cycle(orbit.phase + sign * nudge[:, 0], u + sign * nudge[:, 1])
        turn = reduce_angle(cycle.phase - orbit.phase)
        ends.append(np.stack([turn, cycle.relative_velocity], axis=-1))
    growth = np.sum((ends[0] - ends[1]) * nudge, axis=-1) / (2 * np.sum(nudge * nudge, axis=-1))
    return np.abs(growth / multiplier - 1)


def comparisons(shown: Shown) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Each kind of comparison, the orbits compared and their disagreements.

    The simulation meets those that are orbits of the ball, as the dataset says.
    """
    every = np.arange(shown.orbit.size)
    yield FORMULA, every, _OTHER_ROUTE[shown.made, shown.bifurcation is not None](shown)
    if shown.bifurcation:
        return
    moving = np.flatnonzero(shown.admissible & shown.orbit.can_be_simulated())
    orbit = shown.orbit[moving]
    yield CLOSES, moving, simulation_closes(orbit)
    stable = orbit.is_stable()
    yield HOLDS, moving[stable], simulation_holds(orbit[stable])
    tests = [kind.test(*orbit.trace_and_determinant()) for kind in Bifurcation]
    left = np.min(tests, axis=0) < _UNSTABLE
    yield LEAVES, moving[left], simulation_leaves(orbit[left])


def _compared(name: str, data: xr.Dataset) -> tuple[list[float], list[int]]:
    """Largest disagreement of each kind in a dataset, NaN where there is none, and how many."""
    worst, count = dict.fromkeys(BUDGETS, np.nan), dict.fromkeys(BUDGETS, 0)
    if name not in SHOWN:
        raise CrossCheckError(f"{name}: SHOWN in claims/witness.py does not say what it shows")
    for find in SHOWN[name]:
        try:
            found = list(find(data))
        except KeyError as error:
            raise CrossCheckError(f"{name}: {find.__name__} needs {error.args[0]}") from None
        if not any(shown.orbit.size for shown in found):
            raise CrossCheckError(f"{name}: {find.__name__} compares nothing")
        for shown in found:
            for kind, which, off in comparisons(shown):
                if not off.size:
                    continue
                values = np.where(np.isnan(off), np.inf, off)
                largest, at = values.max(), which[values.argmax()]
                if largest > BUDGETS[kind]:
                    raise CrossCheckError(
                        f"{name}: {kind} disagree by {largest:.1e}, more than "
                        f"{BUDGETS[kind]:.0e}, at the {shown.name(at)}"
                    )
                worst[kind] = float(np.fmax(worst[kind], largest))
                count[kind] += values.size
    return list(worst.values()), list(count.values())


def witness(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Largest disagreement of every kind for every figure and table that shows an orbit.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        The datasets of :data:`SHOWN`, or some of them.

    Raises
    ------
    CrossCheckError
        If a disagreement exceeds its budget, with the orbit named, or if a dataset does
        not hold the orbits that it should show.
    """
    if not data:
        raise ModelError("no datasets to cross-check")
    rows = [_compared(name, dataset) for name, dataset in data.items()]
    dims = ("artifact", "comparison")
    return described(
        {
            "disagreement": (dims, [worst for worst, _ in rows]),
            "orbits": (dims, [count for _, count in rows]),
            "budget": ("comparison", list(BUDGETS.values())),
        },
        coords={"artifact": list(data), "comparison": list(BUDGETS)},
    )
