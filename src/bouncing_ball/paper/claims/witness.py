"""Three routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the equations of the model, the *formula* is the closed form of the branch,
and the *simulation* runs from event to event. Every published orbit and bifurcation is taken from
its dataset and computed by each route. Because the routes share the equations of impact and flight,
their agreement checks the numerical methods and not these equations. This module measures the
disagreements; a test requires that they are within their budgets.
"""

from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.spring_damper_model import SpringDamperModel
from bouncing_ball.numerics.corrector import NewtonSettings, newton, plane, tangent
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.periodic.closed_forms import nearest
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.paper_unknowns import PaperUnknowns
from bouncing_ball.periodic.special import bifurcations
from bouncing_ball.periodic.stability import Bifurcation

VARIABLES = {
    "artifact": Variable("figure or table whose orbits are compared"),
    "comparison": Variable("the two routes compared"),
}
# Kinds of comparison and their budgets, relative to the larger of Λ and n. Continuation and formula
# are both exact up to rounding, which is amplified where the branch merges with permanent contact:
# the impact velocity is 1e-4 at the end of the branches there, and the rounding errors of the
# orbit's equations are divided by it. One cycle of the simulation adds an error of the same size.
FORMULA, CLOSES = "continuation and formula", "simulation over one cycle"
BUDGETS = {FORMULA: 1e-11, CLOSES: 1e-10}
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
    arrays = xr.broadcast(*(xr.DataArray(known[name]) for name in names))
    columns = [array.values.ravel() for array in arrays]
    present = np.isfinite(columns[0])
    return (column[present] for column in columns)


def _contacts(data: xr.Dataset, *names: str) -> tuple[Any, ...]:
    """The models of spring-damper orbits, n, and further variables, each as a flat array."""
    *values, r, omega, n = _row(data, *names, "restitution", "frequency_ratio", "n")
    contact = SpringDamper.from_restitution(r, omega, data.attrs["release"])
    return SpringDamperModel(contact), n, *values


def contact_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the spring-damper model along Λ or ϖ."""
    names = ("contact_duration", "phase", "impact_velocity", "amplitude", "admissible")
    model, n, duration, phase, velocity, lam, admissible = _contacts(data, *names)
    yield Shown(model, Orbit.of(model, n, lam, phase, duration, velocity), None, admissible)


def restitution_orbits(data: xr.Dataset) -> Iterator[Shown]:
    """The orbits of the restitution model along Λ."""
    beside = "restitution_" if "restitution_amplitude" in data else ""
    phase, lam, admissible, r, n = _row(
        data,
        f"{beside}phase",
        f"{beside}amplitude",
        f"{beside}admissible",
        "restitution",
        "n",
    )
    model = RestitutionModel(r)
    yield Shown(model, Orbit.of(model, n, lam, phase), None, admissible)


def restitution_bifurcations(data: xr.Dataset) -> Iterator[Shown]:
    """Both bifurcations of each family of the restitution model."""
    exact = data.sel(impact_map="exact") if "impact_map" in data.dims else data
    for kind in Bifurcation:
        name = kind.name.lower()
        phase, lam, r, n = _row(exact, f"{name}_phase", f"{name}_amplitude", "restitution", "n")
        model = RestitutionModel(r)
        yield Shown(model, Orbit.of(model, n, lam, phase), kind)


def located(data: xr.Dataset) -> Iterator[Shown]:
    """Bifurcations that a continuation located: along branches, or in Table 1."""
    for kind in Bifurcation:
        if "special_kind" in data:
            amplitude = data["special_amplitude"].where(data.special_kind == kind)
            part = data.assign(amplitude_there=amplitude)
        else:
            part = data.assign(amplitude_there=data["computed"]).sel(bound=kind)
        names = ("amplitude_there", "special_phase", "special_contact_duration")
        model, n, lam, phase, duration = _contacts(part, *names)
        yield Shown(model, Orbit.of(model, n, lam, phase, duration), kind)


SHOWN: dict[Callable[[xr.Dataset], Iterator[Shown]], tuple[str, ...]] = {
    contact_orbits: (
        "fig05",
        "fig06",
        "fig07",
        "fig08",
        "fig09",
        "fig10",
        "fig12",
        "fig13",
        "fig14",
        "fig15",
    ),
    restitution_orbits: ("fig02", "fig03", "fig15"),
    restitution_bifurcations: ("fig03", "fig15"),
    located: ("fig08", "fig09", "fig15", "table1"),
}
"""The datasets that show each kind of orbits."""


# The comparisons.


def _by_equations(shown: Shown, near: Orbit) -> Orbit:
    """Solutions of the model's equations next to orbits, by Newton's method; NaN where it fails.

    A bifurcation is solved for together with its test function. An orbit is solved for in the plane
    normal to its branch. This is well conditioned at a fold, too, where Λ determines only half of
    the digits.
    """
    system = PaperUnknowns.of(near)
    kind = shown.bifurcation
    y = system.point(near)
    if kind:
        events = (system.event(each) for each in bifurcations(system.orbits))
        condition = next(each.condition for each in events if each.name == kind)
    else:
        jacobian = np.nan_to_num(system.jacobian(y), posinf=0.0, neginf=0.0)
        condition = plane(tangent(jacobian, y), y)
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
    orbit = shown.orbit
    near = nearest(shown.orbit)
    found = _by_equations(shown, near)
    if not shown.bifurcation:
        return np.maximum(orbit.distance(near), orbit.distance(found)) / _size(orbit)
    lam = orbit.amplitude - found.amplitude
    turn = reduce_angle(orbit.phase - found.phase)
    return np.max(np.abs([lam, turn, near.distance(found)]), axis=0) / _size(orbit)


def _size(orbit: Orbit) -> np.ndarray:
    """The size to which differences of orbits are relative: the larger of Λ and n."""
    return np.maximum(orbit.amplitude, orbit.n)


def simulation_returns(orbit: Orbit) -> np.ndarray:
    """Distance of the simulation from orbits after one cycle, shape (orbits,).

    The distance is the largest difference in φ, δ′ and the period, relative to the larger of Λ and
    n.
    """
    phase = orbit.phase
    speed = orbit.relative_impact_velocity
    cycle = orbit.model.cycle(orbit.amplitude, phase, speed)
    turned = reduce_angle(cycle.phase - phase)
    faster = cycle.relative_velocity - speed
    return np.max(np.abs([cycle.time - 2 * np.pi * orbit.n, turned, faster]), axis=0) / _size(orbit)


def disagreements(name: str, data: xr.Dataset) -> dict[str, np.ndarray]:
    """The disagreement of each kind for every orbit of a dataset; inf if a route finds no orbit.

    Only orbits that are admissible according to the dataset are simulated, and no bifurcations.
    """
    try:
        found = [list(find(data)) for find, names in SHOWN.items() if name in names]
    except KeyError as error:
        raise ModelError(f"{name} lacks a variable: {error.args[0]}") from error
    if not all(sum(part.orbit.size for part in parts) for parts in found or [[]]):
        raise ModelError(f"{name}: no orbit to compare")
    every = {kind: [np.empty(0)] for kind in BUDGETS}
    for part in chain(*found):
        every[FORMULA].append(formula_and_equations(part))
        if not part.bifurcation:
            admissible = part.orbit[part.admissible.astype(bool)]
            every[CLOSES].append(simulation_returns(admissible))
    return {kind: np.nan_to_num(np.concatenate(x), nan=np.inf) for kind, x in every.items()}


def witness(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Largest disagreement of every kind for every figure and table that shows an orbit.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        Some of the datasets in :data:`SHOWN`.

    Returns
    -------
    xarray.Dataset
        ``disagreement``, NaN for a kind without orbits, and ``orbits``, their number, over
        (artifact, comparison); ``budget`` over comparison.

    Raises
    ------
    ModelError
        If a dataset lacks a variable, or orbits of a kind that it should show.
    """
    found = [list(disagreements(*item).values()) for item in data.items()]
    worst = [[max(values, default=np.nan) for values in kinds] for kinds in found]
    return described(
        {
            "disagreement": (("artifact", "comparison"), worst),
            "orbits": (("artifact", "comparison"), [list(map(len, kinds)) for kinds in found]),
            "budget": ("comparison", list(BUDGETS.values())),
        },
        coords={"artifact": list(data), "comparison": list(BUDGETS)},
        variables=VARIABLES,
    )
