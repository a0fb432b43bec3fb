"""Three routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the equations of the model, the *formula* is the closed form of the branch,
and the *simulation* runs from event to event. The routes share the equations of impact and flight,
so that their agreement checks the numerical methods and not these equations.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import restitution_branch
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    excess_angle,
    nearest_excess,
    orbits_on_branch,
)
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.stability import Bifurcation

from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.numerics.corrector import NewtonSettings, newton, null_vector, plane
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.claims import FORMULA

VARIABLES = {
    "artifact": Variable("figure or table whose orbits are compared"),
    "comparison": Variable("the two routes compared"),
}
CLOSES = "simulation over one cycle"
# Relative to the larger of Λ and n. Rounding errors are divided by the impact velocity, which is
# 1e-4 at the end of the branches that merge with permanent contact.
BUDGETS = {FORMULA: 1e-11, CLOSES: 1e-10}


class Shown(NamedTuple):
    """Orbits of one model; each is admissible or not, or all are at one bifurcation."""

    orbit: Orbit
    admissible: np.ndarray
    bifurcation: Bifurcation | None


def _columns(data: xr.Dataset, *names: str) -> Iterator[np.ndarray]:
    """Variables or parameters as flat arrays, without the places where the first one is NaN."""
    # If a dataset does not say so, all its orbits are admissible.
    unsaid = {name: True for name in names if name.endswith("admissible")}
    known = {**unsaid, **data.attrs, **data.coords, **data}
    arrays = xr.broadcast(*(xr.DataArray(known[name]) for name in names))
    present = np.isfinite(arrays[0].values.ravel())
    return (array.values.ravel()[present] for array in arrays)


def spring_damper_model_orbits(
    data: xr.Dataset, prefix: str = "", kind: Bifurcation | None = None
) -> Shown:
    """Orbits of the spring-damper model; of a bifurcation a dataset does not have z′_i."""
    names = [prefix + name for name in ("contact_duration", "amplitude", "phase", "admissible")]
    names += ["restitution", "frequency_ratio", "n"]
    names += [] if kind else ["impact_velocity"]
    duration, lam, phase, admissible, r, ratio, n, *velocity = _columns(data, *names)
    model = ContactModel(SpringDamper.from_restitution(r, ratio, data.attrs["release"]))
    return Shown(Orbit.of(model, n, lam, phase, duration, *velocity), admissible, kind)


def restitution_model_orbits(
    data: xr.Dataset, prefix: str = "", kind: Bifurcation | None = None
) -> Shown:
    """Orbits of the restitution model."""
    names = [prefix + name for name in ("phase", "amplitude", "admissible")]
    phase, lam, admissible, r, n = _columns(data, *names, "restitution", "n")
    model = RestitutionModel(r)
    return Shown(Orbit.of(model, n, lam, phase), admissible, kind)


def all_orbits(name: str, data: xr.Dataset) -> Iterator[Shown]:
    """All orbits and bifurcations in the dataset of a figure or of Table 1."""
    if name in ("fig02", "fig03", "fig15"):
        yield restitution_model_orbits(data, "restitution_" if name == "fig15" else "")
    if name not in ("fig02", "fig03", "table1"):
        yield spring_damper_model_orbits(data)
    for kind in Bifurcation:
        if name in ("fig03", "fig15"):
            exact = data.sel(impact_map="exact") if name == "fig03" else data
            yield restitution_model_orbits(exact, f"{kind.name.lower()}_", kind)
        if name in ("fig08", "fig09", "fig15"):
            here = data.special_contact_duration.where(data.special_kind == kind)
            yield spring_damper_model_orbits(
                data.assign(special_contact_duration=here), "special_", kind
            )
        if name == "table1":
            table = data.sel(bound=kind)
            yield spring_damper_model_orbits(
                table.assign(special_amplitude=table["computed"]), "special_", kind
            )


def nearest(orbit: Orbit) -> Orbit:
    """The points nearest to given orbits on the closed form of the branch, of their shape.

    The distance is that in (Λ cos φ, Λ sin φ), and in ε for the spring-damper model.
    """
    model: Any = orbit.model
    x = orbit.amplitude * np.cos(orbit.phase)
    y = orbit.amplitude * np.sin(orbit.phase)
    if isinstance(model, RestitutionModel):
        fold = restitution_branch.saddle_node(orbit.n, model.restitution)
        return Orbit.of(model, orbit.n, np.hypot(fold, y), np.arctan2(y, fold))
    contact = model.law
    excess = excess_angle(contact, orbit.contact_duration)
    return orbits_on_branch(nearest_excess(contact, orbit.n, x, y, excess), contact, orbit.n)


def formula_and_equations(shown: Shown) -> np.ndarray:
    """Distance of each orbit from the closed form, plus that of the closed form from the equations.

    The latter is the Newton step across the branch, or at a bifurcation the step to a zero of its
    test function. Of a bifurcation a dataset has Λ and φ only.
    """
    orbit = shown.orbit
    near = nearest(orbit)
    system = PaperUnknowns.of(near)
    y = system.point(near)
    condition = plane(null_vector(system.jacobian(y)), y)
    distance = orbit.distance(near)
    if shown.bifurcation:
        kind = shown.bifurcation
        condition = system.condition(lambda inner: system.equations.bifurcation(kind, inner))
        turn = reduce_angle(orbit.phase - near.phase)
        distance = np.maximum(abs(orbit.amplitude - near.amplitude), abs(turn))
    with np.errstate(all="ignore"):
        step = newton(system, y, condition, NewtonSettings(max_iterations=1)).step
    return distance + step * (1 + np.linalg.norm(y, axis=-1))


def simulation_returns(orbit: Orbit) -> np.ndarray:
    """Largest change of φ, δ′ and the period in one simulated cycle from each orbit."""
    speed = orbit.relative_impact_velocity
    cycle = orbit.model.cycle(orbit.amplitude, orbit.phase, speed)
    late = cycle.time - 2 * np.pi * orbit.n
    turned = reduce_angle(cycle.phase - orbit.phase)
    return np.max(np.abs([late, turned, cycle.relative_velocity - speed]), axis=0)


def disagreements(name: str, data: xr.Dataset) -> list[np.ndarray]:
    """The disagreements of each kind for all orbits of a dataset; inf where a route fails."""
    found: dict[str, list] = {kind: [[]] for kind in BUDGETS}
    for one in all_orbits(name, data):
        size = np.maximum(one.orbit.amplitude, one.orbit.n)
        found[FORMULA].append(formula_and_equations(one) / size)
        if not one.bifurcation:
            admissible = one.admissible.astype(bool)
            found[CLOSES].append(simulation_returns(one.orbit[admissible]) / size[admissible])
    return [np.nan_to_num(np.hstack(parts), nan=np.inf, posinf=np.inf) for parts in found.values()]


def witness(data: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Largest ``disagreement`` of each kind, its ``budget``, and the number of ``orbits`` compared,
    over (artifact, comparison); NaN for a kind without orbits.
    """
    found = [disagreements(*item) for item in data.items()]
    worst = [[np.max(values) if values.size else np.nan for values in kinds] for kinds in found]
    return described(
        {
            "disagreement": (("artifact", "comparison"), worst),
            "orbits": (("artifact", "comparison"), [[x.size for x in kinds] for kinds in found]),
            "budget": ("comparison", list(BUDGETS.values())),
        },
        coords={"artifact": list(data), "comparison": list(BUDGETS)},
        variables=VARIABLES,
    )
