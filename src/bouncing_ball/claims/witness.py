"""Three routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the model's equations, the *formula* is the closed form of its
branch, the *simulation* runs from event to event. Every published orbit and bifurcation
is taken from its dataset and computed by each of them. The routes share the equations of
impact and flight: their agreement checks the numerical methods.
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
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Bifurcation

# Periods over which the simulation must remain on a stable orbit.
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

# Perturbation of an unstable orbit as a share of the impact velocity, which may be small.
_NUDGE = 1e-8
# Test function below which the departure from an orbit is measured. Nearer to the bifurcations
# the multiplier is close to ±1, and a departure shows nothing.
_UNSTABLE = -0.05
_NEWTON = NewtonSettings(max_iterations=20)
# Orbits of a dataset without such a variable are admissible.
_UNSAID = {"admissible": True, "restitution_admissible": True}


class Shown(NamedTuple):
    """Orbits of one model in a row, or bifurcations, as a dataset shows them.

    ``admissible`` is the dataset's statement on each orbit.
    """

    model: ImpactModel
    orbit: Any
    bifurcation: Bifurcation | None = None
    admissible: Any = None


# The orbits of a dataset.


def _row(data: xr.Dataset, *names: str) -> Iterator[np.ndarray]:
    """Variables or parameters of a dataset as rows, without the places where the first is NaN."""
    known = {**_UNSAID, **data.attrs, **data.coords, **data}
    flat = [x.values.ravel() for x in xr.broadcast(*(xr.DataArray(known[x]) for x in names))]
    return (column[np.isfinite(flat[0])] for column in flat)


def _contacts(data: xr.Dataset, *names: str) -> tuple[Any, ...]:
    """The models of spring-damper orbits, their n, and variables of them, each as a row."""
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

    A bifurcation is found with its test function. An orbit is found in the plane that is
    normal to its branch, which is well conditioned at a fold too, where Λ determines half of the
    digits only.
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
    # At the limit of rounding the last step may remain longer than the tolerance.
    good = found.converged | (found.residual < BUDGETS[FORMULA])
    return system.orbit(np.where(good[:, np.newaxis], found.point, np.nan))


def formula_and_equations(shown: Shown) -> np.ndarray:
    """Distance of every orbit from the closed form, and from the equations' solution there.

    For a bifurcation, which a dataset has with Λ and φ, it is the distance in both. Shape
    (orbits,), relative to the larger of Λ and n.
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

    It is the largest difference in φ, δ′ and the last period, relative to the larger of Λ and n.
    """
    phase, speed = start = orbit.phase, orbit.relative_impact_velocity
    for _ in range(cycles):
        cycle = orbit.cycle(phase, speed)
        phase, speed = cycle.phase, cycle.relative_velocity
    off = cycle.time - 2 * np.pi * orbit.n, reduce_angle(phase - start[0]), speed - start[1]
    return np.max(np.abs(off), axis=0) / _size(orbit)


def simulation_leaves(orbit: Orbit) -> np.ndarray:
    """Relative error of the rate at which the simulation leaves unstable orbits, against the
    multiplier.

    The simulation starts near the orbit on both sides, along the unstable direction. Shape
    (orbits,).
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
    """Each kind of comparison, with the disagreements of the orbits compared.

    Only orbits that are admissible by the dataset are simulated.
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
    """Largest disagreement of each kind in a dataset, NaN where there is none, and the counts."""
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
        The datasets of :data:`SHOWN`, or some of them.

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
