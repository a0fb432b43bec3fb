"""Three routes to every orbit that a figure or Table 1 shows.

*Continuation* solves the equations of the model, the *formula* is the closed form of the branch,
and the *simulation* runs from event to event. The routes share the equations of impact and flight,
so that their agreement checks the numerical methods and not these equations.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.simulation import next_impact
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.numerics.corrector import NewtonSettings, newton, null_vector, plane
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.numerics.events import vanishing
from bouncing_ball.paper.claims import FORMULA
from bouncing_ball.periodic.continuation import PaperEquations
from bouncing_ball.periodic.orbit import Bifurcation, Orbit, difference, trace_and_determinant
from bouncing_ball.periodic.restitution_branch import RestitutionBranch
from bouncing_ball.periodic.spring_damper_branch import branch_point, nearest_excess

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
    model = SpringDamper.from_restitution(r, ratio, data.attrs["release"])
    speed = velocity[0] if velocity else 0.0 * phase
    return Shown(Orbit(model, n, lam, phase, duration, speed), admissible, kind)


def restitution_model_orbits(
    data: xr.Dataset, prefix: str = "", kind: Bifurcation | None = None
) -> Shown:
    """Orbits of the restitution model."""
    names = [prefix + name for name in ("phase", "amplitude", "admissible")]
    phase, lam, admissible, r, n = _columns(data, *names, "restitution", "n")
    orbit = Orbit(RestitutionModel(r), n, lam, phase, 0.0 * phase, -n * np.pi)
    return Shown(orbit, admissible, kind)


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
    if isinstance(model, RestitutionModel):
        return RestitutionBranch(model).at(orbit.n, orbit.amplitude * np.sin(orbit.phase))
    return branch_point(nearest_excess(orbit), model, orbit.n).orbit


def formula_and_equations(shown: Shown) -> np.ndarray:
    """Distance of each orbit from the closed form, plus that of the closed form from the equations.

    For the spring-damper model the latter is the Newton step across the branch in the paper's
    unknowns, or at a bifurcation the step to a zero of its test function. For the restitution model
    it is the defect of Eq. 6 or of this function. Of a bifurcation a dataset has Λ and φ only.
    """
    orbit = shown.orbit
    near = nearest(orbit)
    turn = np.abs(reduce_angle(orbit.phase - near.phase))
    kind = shown.bifurcation
    distance = np.maximum(np.abs(orbit.amplitude - near.amplitude), turn)
    if kind is None:
        distance = difference(orbit, near)
    model: Any = near.model
    if isinstance(model, RestitutionModel):
        r = model.restitution
        push = (1 + r) * near.amplitude * np.cos(near.phase)
        step = np.abs(near.bounce_velocity + r * near.impact_velocity - push)
        tested = 0.0 if kind is None else np.abs(kind.test(*trace_and_determinant(near)))
        return distance + step + tested
    equations = PaperEquations(model, near.n)
    y = equations.point(near)
    if kind is None:
        condition = plane(null_vector(equations.jacobian(y)), y)
    else:
        condition = vanishing(lambda point: equations.test(kind, point))
    with np.errstate(all="ignore"):
        step = newton(equations, y, condition, NewtonSettings(max_iterations=1)).step
    step = step * (1 + np.linalg.norm(y, axis=-1))
    # Eq. 12 has no A and B at the undamped resonance; its flow is regular there.
    resonant = (model.damping_ratio == 0) & (model.frequency_ratio == 1)
    return distance + np.where(resonant, _defect_of_flow(near), step)


def _defect_of_flow(orbit: Orbit) -> np.ndarray:
    """The largest defect of Eqs. 23-26, with the flow in contact in place of A and B."""
    start = orbit.phase, orbit.relative_impact_velocity, orbit.amplitude
    gap, rate = orbit.model.released(orbit.contact_duration, *start)
    landing = orbit.amplitude * np.sin(orbit.release_phase) - orbit.bounce_height
    return np.max(np.abs([gap, rate - orbit.relative_bounce_velocity, landing]), axis=0)


def simulation_returns(orbit: Orbit) -> np.ndarray:
    """Largest change of φ, δ′ and the period in one simulated cycle from each orbit."""
    speed = orbit.relative_impact_velocity
    cycle = next_impact(orbit.model, orbit.phase, speed, orbit.amplitude)
    late = cycle.time - 2 * np.pi * orbit.n
    turned = reduce_angle(cycle.phase - orbit.phase)
    return np.max(np.abs([late, turned, cycle.velocity - speed]), axis=0)


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
