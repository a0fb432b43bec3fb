"""Three routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the equations of the model, the *formula* is the closed form of the branch,
and the *simulation* runs from event to event. Every published orbit and bifurcation is taken from
its dataset and computed by each route. Because the routes share the equations of impact and flight,
their agreement checks the numerical methods and not these equations.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.continuation.corrector import NewtonSettings, newton, plane
from bouncing_ball.continuation.events import vanishing
from bouncing_ball.datasets.variables import described
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import reduce_angle
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation

# Periods over which the simulation must remain on a stable orbit.
HELD_PERIODS = 50
# Kinds of comparison and their budgets, relative to the larger of Λ and n. Continuation and formula
# are both exact up to rounding, which is amplified where the branch merges with permanent contact:
# the impact velocity is 1e-4 at the end of the branches there, and the rounding errors of the
# orbit's equations are divided by it. One cycle of the simulation adds an error of the same size,
# and fifty cycles accumulate. The departure is a difference quotient over 1e-8 of the impact
# velocity, so that rounding, 1e-15, leaves seven digits, and one or two fewer near that merger.
FORMULA, CLOSES = "continuation and formula", "simulation over one cycle"
HOLDS = f"simulation over {HELD_PERIODS} cycles, stable orbits"
LEAVES = "rate of departure, unstable orbits"
BUDGETS = {FORMULA: 1e-11, CLOSES: 1e-10, HOLDS: 1e-9, LEAVES: 1e-5}

# Perturbation of an unstable orbit, relative to the impact velocity because that may be small.
_NUDGE = 1e-8
# The departure from an orbit is measured if the test function is below this value. Nearer to a
# bifurcation the multiplier is close to ±1, and the ball hardly departs.
_UNSTABLE = -0.05
_NEWTON = NewtonSettings(max_iterations=20)
# If a dataset has no such variable, all its orbits are admissible.
_UNSAID = {"admissible": True, "restitution_admissible": True}


class Shown(NamedTuple):
    """Orbits or bifurcations of one model along one axis, with the values of a dataset.

    ``admissible`` tells for each orbit whether it is admissible according to the dataset.
    """

    model: RestitutionModel | SpringDamperModel
    orbit: Any
    bifurcation: Bifurcation | None = None
    admissible: Any = None


# The orbits of a dataset.


def _row(data: xr.Dataset, *names: str) -> Iterator[np.ndarray]:
    """Variables or parameters as flat arrays, without the places where the first one is NaN."""
    known = {**_UNSAID, **data.attrs, **data.coords, **data}
    flat = [x.values.ravel() for x in xr.broadcast(*(xr.DataArray(known[x]) for x in names))]
    return (column[np.isfinite(flat[0])] for column in flat)


def _contacts(data: xr.Dataset, *names: str) -> tuple[Any, ...]:
    """The models of spring-damper orbits, n, and further variables, each as a flat array."""
    *values, r, omega, n = _row(data, *names, "restitution", "frequency_ratio", "n")
    contact = SpringDamper.from_restitution(r, omega, data.attrs["release"])
    return SpringDamperModel(contact), n, *values


def contact_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the spring-damper model along Λ or ϖ."""
    names = ("contact_duration", "phase", "impact_velocity", "amplitude", "admissible")
    model, n, duration, phase, velocity, lam, admissible = _contacts(data, *names)
    yield Shown(model, model.orbit_of(n, lam, phase, duration, velocity), None, admissible)


def restitution_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the restitution model, and both bifurcations of each family."""
    beside = "restitution_" if "restitution_amplitude" in data else ""
    names = (beside + x for x in ("phase", "amplitude", "admissible"))
    phase, lam, admissible, r, n = _row(data, *names, "restitution", "n")
    model = RestitutionModel(r)
    yield Shown(model, model.orbit_of(n, lam, phase), None, admissible)
    if "saddle_node_amplitude" not in data:
        return
    n, first = np.unique(n, return_index=True)
    model = RestitutionModel(r[first])
    exact = data.sel(impact_map="exact") if "impact_map" in data.dims else data
    for kind in Bifurcation:
        end = (exact[f"{kind.name.lower()}_{part}"].values for part in ("amplitude", "phase"))
        yield Shown(model, model.orbit_of(n, *map(np.atleast_1d, end)), kind)


def located(data: xr.Dataset) -> Iterator[Shown]:
    """Bifurcations that a continuation located: along branches, or in Table 1."""
    for kind in Bifurcation:
        if "special_kind" in data:
            part = data.assign(place=data.special_amplitude.where(data.special_kind == kind))
        else:
            part = data.sel(bound=kind).rename(computed="place")
        names = ("place", "special_phase", "special_contact_duration")
        model, n, *limit = _contacts(part, *names)
        yield Shown(model, model.orbit_of(n, *limit), kind)


# The kinds of orbits in each dataset.
SHOWN: dict[str, tuple[Callable[[xr.Dataset], Iterator[Shown]], ...]] = {
    **{name: (restitution_orbits,) for name in ("fig02", "fig03")},
    **{f"fig{k:02d}": (contact_orbits,) for k in (5, 6, 7)},
    **{name: (contact_orbits, located) for name in ("fig08", "fig09")},
    **{f"fig{k}": (contact_orbits,) for k in (10, 12, 13, 14)},
    "fig15": (contact_orbits, restitution_orbits, located),
    "table1": (located,),
}


# The comparisons.


def _by_equations(shown: Shown, near: Orbit) -> Orbit:
    """Solutions of the model's equations next to orbits, by Newton's method; NaN where it fails.

    A bifurcation is solved for together with its test function. An orbit is solved for in the plane
    normal to its branch. This is well conditioned at a fold, too, where Λ determines only half of
    the digits.
    """
    system, kind = shown.model.system(near.n), shown.bifurcation
    y = system.point(near)
    if kind:
        condition = vanishing(next(one.function for one in system.events() if one.name == kind))
    else:
        # The null vector of the Jacobian is the tangent of the branch.
        jacobian = np.nan_to_num(system.jacobian(y), posinf=0.0, neginf=0.0)
        condition = plane(np.linalg.svd(jacobian)[2][..., -1, :], y)
    with np.errstate(all="ignore"):
        found = newton(system, y, condition, _NEWTON)
    # Because of rounding, the last Newton step may remain longer than the tolerance.
    good = found.converged | (found.residual < BUDGETS[FORMULA])
    return system.orbit(np.where(good[:, np.newaxis], found.point, np.nan))


def formula_and_equations(shown: Shown) -> np.ndarray:
    """Distance of every orbit from the closed form and from the solution of the equations.

    For a bifurcation it is the distance in Λ and φ, which the dataset has. The result has shape
    (orbits,) and is relative to the larger of Λ and n.
    """
    orbit, near = shown.orbit, shown.model.nearest(shown.orbit)
    found = _by_equations(shown, near)
    if not shown.bifurcation:
        return np.maximum(orbit.distance(near), orbit.distance(found)) / _size(orbit)
    lam, turn = orbit.amplitude - found.amplitude, reduce_angle(orbit.phase - found.phase)
    return np.max(np.abs([lam, turn, near.distance(found)]), axis=0) / _size(orbit)


def _size(orbit: Orbit) -> np.ndarray:
    """The size to which differences of orbits are relative: the larger of Λ and n."""
    return np.maximum(orbit.amplitude, orbit.n)


def simulation_returns(orbit: Orbit, cycles: int) -> np.ndarray:
    """Distance of the simulation from orbits after some cycles, shape (orbits,).

    The distance is the largest difference in φ, δ′ and the last period, relative to the larger of
    Λ and n.
    """
    phase, speed = start = orbit.phase, orbit.relative_impact_velocity
    for _ in range(cycles):
        cycle = orbit.cycle(phase, speed)
        phase, speed = cycle.phase, cycle.relative_velocity
    off = cycle.time - 2 * np.pi * orbit.n, reduce_angle(phase - start[0]), speed - start[1]
    return np.max(np.abs(off), axis=0) / _size(orbit)


def simulation_leaves(orbit: Orbit) -> np.ndarray:
    """Relative difference between the rate at which the simulation leaves unstable orbits and the
    multiplier, shape (orbits,).

    The simulation starts on both sides of the orbit along the unstable direction.
    """
    values, vectors = np.linalg.eig(orbit.monodromy())
    every, which = np.arange(orbit.size), np.argmax(np.abs(values), axis=-1)
    nudge = _NUDGE * np.abs(orbit.relative_impact_velocity) * vectors[every, :, which].real.T
    at = np.stack([orbit.phase, orbit.relative_impact_velocity])
    ahead, behind = (orbit.cycle(*(at + x)) for x in (nudge, -nudge))
    faster = ahead.relative_velocity - behind.relative_velocity
    apart = np.stack([reduce_angle(ahead.phase - behind.phase), faster])
    growth = np.sum(apart * nudge, axis=0) / (2 * np.sum(nudge * nudge, axis=0))
    return np.abs(growth / values[every, which].real - 1)


def comparisons(shown: Shown) -> Iterator[tuple[str, np.ndarray]]:
    """Each kind of comparison, with the disagreement for each orbit compared.

    Only orbits that are admissible according to the dataset are simulated.
    """
    yield FORMULA, formula_and_equations(shown)
    if shown.bifurcation:
        return
    orbit = shown.orbit[shown.admissible.astype(bool)]
    tests = [kind.test(*orbit.trace_and_determinant()) for kind in Bifurcation]
    yield CLOSES, simulation_returns(orbit, 1)
    yield HOLDS, simulation_returns(orbit[orbit.is_stable()], HELD_PERIODS)
    yield LEAVES, simulation_leaves(orbit[np.min(tests, axis=0) < _UNSTABLE])


def _compared(name: str, data: xr.Dataset) -> tuple[list[float], list[int]]:
    """Largest disagreement of each kind in a dataset, and the number of orbits compared.

    The disagreement is NaN for a kind without orbits.
    """
    off: dict[str, list[float]] = {kind: [] for kind in BUDGETS}
    for find in SHOWN[name]:
        compared = [pair for shown in find(data) for pair in comparisons(shown)]
        if not any(values.size for _, values in compared):
            raise ModelError(f"{name}: {find.__name__} compares nothing")
        for kind, values in compared:
            # If a route does not find the orbit, its distance is infinite.
            off[kind] += np.nan_to_num(values, nan=np.inf).tolist()
            if (worst := max(off[kind], default=0)) > (budget := BUDGETS[kind]):
                raise ModelError(f"{name}: {kind} disagree by {worst:.1e}, more than {budget:.0e}")
    return [max(values, default=np.nan) for values in off.values()], list(map(len, off.values()))


def witness(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Largest disagreement of every kind for every figure and table that shows an orbit.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        All or some of the datasets in :data:`SHOWN`.

    Returns
    -------
    xarray.Dataset
        ``disagreement`` and ``orbits``, their number, over (artifact, comparison); ``budget`` over
        comparison.

    Raises
    ------
    ModelError
        If a disagreement exceeds its budget, or nothing is compared.
    """
    worst, counts = zip(*(_compared(name, dataset) for name, dataset in data.items()), strict=True)
    dims = ("artifact", "comparison")
    return described(
        {
            "disagreement": (dims, np.array(worst)),
            "orbits": (dims, np.array(counts)),
            "budget": ("comparison", list(BUDGETS.values())),
        },
        coords={"artifact": list(data), "comparison": list(BUDGETS)},
    )
