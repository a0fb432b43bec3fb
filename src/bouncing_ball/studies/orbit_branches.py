"""Existence and stability of n-T orbits by continuation (Figs. 8, 9, 15; Table 1).

As the paper does it: from the restitution orbit at a very stiff contact,
along ϖ to the contact wanted, then along Λ to both sides.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.continuation.branch import (
    Branch,
    ContinuationError,
    continue_both_ways,
    continue_branch,
    resample,
    solve_at,
)
from bouncing_ball.continuation.corrector import NewtonSettings
from bouncing_ball.continuation.events import Event, fold, parameter_bound
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.impacts.damping import damping_ratio
from bouncing_ball.impacts.spring_damper import Release
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.admissibility import is_admissible, restitution_is_admissible
from bouncing_ball.orbits.contact_system import OrbitSystem, Parameter
from bouncing_ball.orbits.grazing import grazing_points
from bouncing_ball.orbits.monodromy import trace_and_contraction
from bouncing_ball.orbits.stability import is_stable, multipliers

SADDLE_NODE, PERIOD_DOUBLING = "saddle-node", "period doubling"
GRAZING = "grazing"


def controls(settings: Mapping[str, Any]) -> tuple[StepControl, NewtonSettings]:
    """Step control and Newton settings from the configuration."""
    control = StepControl(
        initial=settings["initial_step"],
        smallest=settings["smallest_step"],
        largest=settings["largest_step"],
        max_angle=settings["max_angle"],
    )
    newton = NewtonSettings(settings["newton_tolerance"], settings["max_newton_iterations"])
    return control, newton


def branch_along_amplitude(
    n: int,
    restitution: float,
    frequency_ratio: float,
    amplitude_max: float,
    release: str,
    settings: Mapping[str, Any],
) -> tuple[OrbitSystem, Branch]:
    """The whole n-T branch up to Λ = ``amplitude_max``, with its special points.

    Raises
    ------
    ContinuationError
        If the way from the restitution orbit to this contact is blocked.
    """
    node = float(restitution_orbits.saddle_node(n, restitution))
    doubling = float(restitution_orbits.period_doubling(n, restitution))
    # Half way between the two bifurcations of the restitution orbit, or to the
    # end of the window; other ways are tried if that one is blocked.
    shares = (0.5, 0.25, 0.9, 1.3)
    ways = [node + share * (min(doubling, amplitude_max) - node) for share in shares]
    failures = []
    for start in (way for way in ways if way <= amplitude_max):
        try:
            y = _orbit_on_the_way(n, restitution, frequency_ratio, start, release, settings)
            break
        except ContinuationError as error:
            failures.append(error)
    else:
        raise failures[0]
    control, newton = controls(settings)
    system = OrbitSystem(
        n, float(damping_ratio(restitution)), Parameter.AMPLITUDE, frequency_ratio, Release(release)
    )
    windows = (
        parameter_bound(0.0, False, "left the window at amplitude 0"),
        parameter_bound(amplitude_max, True, f"left the window at amplitude {amplitude_max:g}"),
    )
    branch = continue_both_ways(
        system,
        np.append(y[:-1], start),
        events=(*system.events(), *windows),
        control=control,
        settings=newton,
    )
    for reason in (branch.start_reason, branch.end_reason):
        if reason.startswith("reached the limit"):
            raise ContinuationError(
                f"the branch of {n}-T orbits at ϖ = {frequency_ratio:g} is not followed to its "
                f"end: {reason}"
            )
    return system, branch


def _orbit_on_the_way(n, restitution, frequency_ratio, start, release, settings) -> np.ndarray:
    """The orbit at Λ = ``start``, followed along ϖ from a very stiff contact."""
    zeta, rule = float(damping_ratio(restitution)), Release(release)
    control, newton = controls(settings)
    stiff = max(settings["stiff_frequency_ratio"], frequency_ratio)
    towards = OrbitSystem(n, zeta, Parameter.LOG_FREQUENCY_RATIO, start, rule)
    y = solve_at(towards, towards.guess(start, stiff), newton)
    if frequency_ratio >= stiff:
        return y
    target = parameter_bound(np.log(frequency_ratio), False, "target reached")
    determinant = fold(towards).function
    side = np.sign(determinant(y))
    turn = Event(
        "turn",
        lambda y: side * determinant(y),
        terminal=True,
        reason="the branch turns back to stiffer contacts",
    )
    way = continue_branch(
        towards,
        y,
        increasing=False,
        events=(*(event for event in towards.events() if event.terminal), turn, target),
        control=control,
        settings=newton,
    )
    if way.end_reason != target.reason:
        raise ContinuationError(
            f"{n}-T orbit at Λ = {start:.4g} followed from ϖ = {stiff:g} ends at "
            f"ϖ = {np.exp(way.points[-1, -1]):.4g}, before {frequency_ratio:g}: "
            f"{way.end_reason}"
        )
    return way.points[-1]


def first_limits(branch: Branch) -> dict[str, np.ndarray]:
    """The saddle-node and the period doubling that bound the first stable range.

    The branch's last saddle-node in its order, from the unstable to the stable
    side, and the first period doubling after it.

    Raises
    ------
    NoOrbitError
        If the branch has not both.
    """
    names = [special.name for special in branch.special]
    nodes = [k for k, name in enumerate(names) if name == SADDLE_NODE]
    node = nodes[-1] if nodes else len(names)
    doublings = [k for k, name in enumerate(names) if name == PERIOD_DOUBLING and k > node]
    if not doublings:
        raise NoOrbitError(
            f"the branch from {branch.start_reason!r} to {branch.end_reason!r} has no "
            f"{PERIOD_DOUBLING if nodes else SADDLE_NODE} to bound its stable range"
        )
    doubling = doublings[0]
    return {
        SADDLE_NODE: branch.special[node].point,
        PERIOD_DOUBLING: branch.special[doubling].point,
    }


def _ragged(rows, fill=np.nan):
    """Rows of different lengths as one array, filled at the end."""
    width = max(len(row) for row in rows)
    out = np.full((len(rows), width), fill, dtype=object if isinstance(fill, str) else float)
    for row, values in zip(out, rows, strict=True):
        row[: len(values)] = values
    return out.astype(str) if isinstance(fill, str) else out


def orbit_branches(
    parameters: Mapping[str, Any], release: str, settings: Mapping[str, Any]
) -> xr.Dataset:
    """Branches along Λ for one n and several ϖ (Figs. 8, 9 and 15)."""
    n, r = parameters["n"], parameters["restitution"]
    ratios = np.array(parameters["frequency_ratio"], dtype=float)
    _, newton = controls(settings)
    names = (
        "amplitude phase contact_duration release_phase impact_velocity bounce_velocity "
        "apparent_restitution stable admissible multiplier_real multiplier_imag residual"
    ).split()
    columns: dict[str, list] = {name: [] for name in names}
    kinds, special_points, residuals, reasons = [], [], [], []
    for ratio in ratios:
        system, branch = branch_along_amplitude(
            n, r, ratio, parameters["amplitude_max"], release, settings
        )
        y = resample(system, branch, parameters["points"], newton)
        orbit = system.orbit(y)
        trace, det = trace_and_contraction(orbit)
        floquet = multipliers(trace, det)
        values = (
            orbit.amplitude,
            orbit.phase,
            orbit.contact_duration,
            orbit.phase + orbit.contact_duration,
            orbit.impact_velocity,
            orbit.bounce_velocity,
            orbit.apparent_restitution,
            is_stable(trace, det),
            is_admissible(orbit),
            floquet.real,
            floquet.imag,
            np.max(np.abs(system.residual(y)), axis=-1),
        )
        for name, value in zip(names, values, strict=True):
            columns[name].append(value)
        chosen = [s for s in branch.special if s.name in (SADDLE_NODE, PERIOD_DOUBLING)]

        def admissible_at(y, system=system):
            return is_admissible(system.orbit(y))

        grazing = grazing_points(system, admissible_at, y, newton)
        kinds.append([*(s.name for s in chosen), *[GRAZING] * len(grazing)])
        points = np.array([*(s.point for s in chosen), *grazing]).reshape(-1, 4)
        special_points.append(points)
        residuals.append(np.max(np.abs(system.residual(points)), axis=-1))
        reasons.append([branch.start_reason, branch.end_reason])
    dims, special = ("frequency_ratio", "point"), ("frequency_ratio", "special")
    floquet_dims = (*dims, "multiplier")
    dataset = xr.Dataset(
        {
            name: (floquet_dims if name.startswith("multiplier") else dims, np.array(values))
            for name, values in columns.items()
        },
        coords={"frequency_ratio": ratios},
    )
    dataset["special_kind"] = (special, _ragged(kinds, ""))
    dataset["special_amplitude"] = (special, _ragged([p[:, 3] for p in special_points]))
    dataset["special_phase"] = (special, _ragged([p[:, 0] for p in special_points]))
    durations = [p[:, 2] / ratio for p, ratio in zip(special_points, ratios, strict=True)]
    dataset["special_contact_duration"] = (special, _ragged(durations))
    dataset["special_residual"] = (special, _ragged(residuals))
    dataset["end_reason"] = (("frequency_ratio", "end"), np.array(reasons))
    return describe(dataset.assign_coords(end=["unstable side", "stable side"]))


def both_domains(
    parameters: Mapping[str, Any], release: str, settings: Mapping[str, Any]
) -> xr.Dataset:
    """The branch of one ϖ beside that of the restitution model (Fig. 15)."""
    n, r, top = parameters["n"], parameters["restitution"], parameters["amplitude_max"]
    contact = orbit_branches(
        {**parameters, "frequency_ratio": [parameters["frequency_ratio"]]}, release, settings
    )
    amplitude, phase = restitution_orbits.branch(n, r, top, parameters["points"])
    doubling = float(restitution_orbits.period_doubling(n, r))
    stable = is_stable(*restitution_orbits.trace_and_determinant(r, amplitude, phase))
    return describe(
        contact.assign(
            restitution_amplitude=("point", amplitude),
            restitution_phase=("point", phase),
            restitution_stable=("point", stable),
            restitution_admissible=("point", restitution_is_admissible(n, amplitude, phase)),
            saddle_node_amplitude=((), float(restitution_orbits.saddle_node(n, r))),
            saddle_node_phase=((), 0.0),
            period_doubling_amplitude=((), doubling),
            period_doubling_phase=((), float(restitution_orbits.phase(n, r, doubling))),
        )
    )


def printed_ranges(
    printed: Mapping[str, Any], parameters: Mapping[str, Any], release: str
) -> np.ndarray:
    """A printed table at the frequency ratios and families computed, shape (ϖ, n, 2).

    NaN where the paper has no entry, and everywhere with another r or another
    release than the paper's: then there is nothing to compare with.

    Examples
    --------
    >>> printed = {"restitution": 0.85, "release": "displacement", "frequency_ratio": [10.0],
    ...            "n": [1], "bound": ["saddle-node", "period doubling"], "values": [[[0.25, 1.0]]]}
    >>> computed = {"restitution": 0.85, "frequency_ratio": [10.0, 5.0], "n": [1]}
    >>> printed_ranges(printed, computed, "displacement").tolist()
    [[[0.25, 1.0]], [[nan, nan]]]
    >>> bool(np.isnan(printed_ranges(printed, computed, "force")).all())
    True
    """
    axes = {key: printed[key] for key in ("frequency_ratio", "n", "bound")}
    table = xr.DataArray(printed["values"], axes)
    wanted = {
        "frequency_ratio": parameters["frequency_ratio"],
        "n": parameters["n"],
        "bound": [SADDLE_NODE, PERIOD_DOUBLING],
    }
    same = (printed["restitution"], printed["release"]) == (parameters["restitution"], release)
    return table.where(same).reindex(wanted).values


def stability_ranges(
    parameters: Mapping[str, Any],
    release: str,
    settings: Mapping[str, Any],
    printed: Mapping[str, Any],
) -> xr.Dataset:
    """Ranges of Λ in which the n-T orbits are stable, computed and printed (Table 1)."""
    n, r = parameters["n"], parameters["restitution"]
    ratios = parameters["frequency_ratio"]
    computed, phase, duration = np.empty((3, len(ratios), len(n), 2))
    for i, ratio in enumerate(ratios):
        for j, family in enumerate(n):
            top = parameters["amplitude_max"]
            _, branch = branch_along_amplitude(family, r, ratio, top, release, settings)
            limits = first_limits(branch)
            for k, kind in enumerate((SADDLE_NODE, PERIOD_DOUBLING)):
                phase[i, j, k], _, angle, computed[i, j, k] = limits[kind]
                duration[i, j, k] = angle / ratio
    families = np.array(n)
    maps = list(restitution_orbits.ImpactMap)
    limit = np.empty((len(maps), len(n), 2))
    limit[..., 0] = restitution_orbits.saddle_node(families, r)
    for k, kind in enumerate(maps):
        limit[k, :, 1] = restitution_orbits.period_doubling(families, r, kind)
    dims = ("frequency_ratio", "n", "bound")
    return describe(
        xr.Dataset(
            {
                "computed": (dims, computed),
                "special_phase": (dims, phase),
                "special_contact_duration": (dims, duration),
                "printed": (dims, printed_ranges(printed, parameters, release)),
                "restitution_range": (("impact_map", "n", "bound"), limit),
            },
            coords={
                "frequency_ratio": np.array(ratios, dtype=float),
                "n": families,
                "bound": [SADDLE_NODE, PERIOD_DOUBLING],
                "impact_map": [str(kind) for kind in maps],
            },
        )
    )
