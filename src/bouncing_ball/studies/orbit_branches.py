"""Existence and stability of n-T orbits by continuation (Figs. 8, 9, 15; Table 1).

As the paper does it: from the restitution orbit at a very stiff contact,
along ϖ to the contact wanted, then along Λ to both sides.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.continuation.branch import (
    STARTED,
    Branch,
    ContinuationError,
    End,
    Ending,
    continue_both_ways,
    continue_branch,
    resample,
    solve_at,
)
from bouncing_ball.continuation.corrector import NewtonSettings, null_vector
from bouncing_ball.continuation.events import Event, fold, parameter_bound
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits import restitution_orbit as restitution_orbits
from bouncing_ball.orbits.grazing import grazing_points
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_system import Parameter, SpringDamperSystem
from bouncing_ball.orbits.stability import Bifurcation
from bouncing_ball.studies.columns import OBSERVED, columns

SADDLE_NODE, PERIOD_DOUBLING = Bifurcation
GRAZING = "grazing"
_REACHED = End(Ending.EVENT, "target reached")


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


def followed_from_stiff(
    n: int,
    contact: SpringDamper,
    amplitude: float,
    stiff: float,
    control: StepControl,
    newton: NewtonSettings,
) -> Branch:
    """The branch in ln ϖ at one Λ, from a very stiff contact to the one wanted.

    It starts at the restitution orbit, and ends before ``contact`` where it
    turns back to stiffer contacts or leaves the domain of the equations.

    Raises
    ------
    ContinuationError
        If there is no orbit near that of the restitution model.
    """
    towards = SpringDamperSystem(
        n, contact.damping_ratio, Parameter.LOG_FREQUENCY_RATIO, amplitude, contact.release
    )
    y = solve_at(towards, towards.guess(amplitude, stiff), newton)
    if contact.frequency_ratio >= stiff:
        along = null_vector(towards.jacobian(y))
        return Branch(y[np.newaxis], along[np.newaxis], (), STARTED, _REACHED)
    target = parameter_bound(np.log(float(contact.frequency_ratio)), False, str(_REACHED))
    determinant = fold(towards).function
    side = np.sign(determinant(y))
    turn = Event(
        "turn",
        lambda y: side * determinant(y),
        terminal=True,
        reason="the branch turns back to stiffer contacts",
    )
    ends = (event for event in towards.events() if event.terminal)
    return continue_branch(
        towards, y, increasing=False, events=(*ends, turn, target), control=control, settings=newton
    )


def _on_the_way(
    n: int, contact: SpringDamper, amplitude: float, settings: Mapping[str, Any]
) -> np.ndarray:
    """(φ, z′_i, ϖ τ_b) of the orbit at Λ, followed along ϖ from a very stiff contact."""
    control, newton = controls(settings)
    omega = float(contact.frequency_ratio)
    stiff = max(settings["stiff_frequency_ratio"], omega)
    way = followed_from_stiff(n, contact, amplitude, stiff, control, newton)
    if way.end != _REACHED:
        raise ContinuationError(
            f"{n}-T orbit at Λ = {amplitude:.4g} followed from ϖ = {stiff:g} ends at "
            f"ϖ = {np.exp(way.points[-1, -1]):.4g}, before {omega:g}: {way.end}"
        )
    return way.points[-1, :-1]


def _start(
    n: int, contact: SpringDamper, restitution: float, top: float, settings: Mapping[str, Any]
) -> np.ndarray:
    """A point of the branch along Λ of a contact, up to Λ = ``top``.

    Half way between the two bifurcations of the restitution orbit, or to the
    end of the window; other ways are tried if that one is blocked. Where all
    are, the branch is not connected with the restitution orbit at any of these
    Λ, and the orbit of the closed form starts it.

    Raises
    ------
    NoOrbitError
        If there is no orbit there either.
    """
    rigid = RestitutionModel(restitution)
    node, doubling = (float(x.amplitude) for x in (rigid.saddle_node(n), rigid.period_doubling(n)))
    ways = [node + share * (min(doubling, top) - node) for share in (0.5, 0.25, 0.9, 1.3)]
    ways = [way for way in ways if way <= top]
    for amplitude in ways:
        try:
            return np.append(_on_the_way(n, contact, amplitude, settings), amplitude)
        except ContinuationError:
            continue
    model = SpringDamperModel(contact)
    found = model.orbit(n, np.array([*ways, (node + top) / 2, top]))
    if not np.any(found.exists):
        raise NoOrbitError(
            f"neither the continuation from the restitution orbit nor the closed form finds a "
            f"{n}-T orbit of {model.label} up to Λ = {top:g}"
        )
    return model.system(n).point(found[np.argmax(found.exists)])


def branch_along_amplitude(
    n: int,
    restitution: float,
    frequency_ratio: float,
    amplitude_max: float,
    release: str,
    settings: Mapping[str, Any],
) -> tuple[SpringDamperSystem, Branch]:
    """The whole n-T branch up to Λ = ``amplitude_max``, with its special points.

    Raises
    ------
    NoOrbitError
        If there is none.
    ContinuationError
        If it is not followed to its end.
    """
    control, newton = controls(settings)
    contact = SpringDamper.from_restitution(restitution, frequency_ratio, Release(release))
    system = SpringDamperModel(contact).system(n)
    windows = (
        parameter_bound(0.0, False, "left the window at amplitude 0"),
        parameter_bound(amplitude_max, True, f"left the window at amplitude {amplitude_max:g}"),
    )
    branch = continue_both_ways(
        system,
        _start(n, contact, restitution, amplitude_max, settings),
        events=(*system.events(), *windows),
        control=control,
        settings=newton,
    )
    for end in (branch.start, branch.end):
        if end.kind is Ending.POINTS:
            raise ContinuationError(
                f"the branch of {n}-T orbits at ϖ = {frequency_ratio:g} is not "
                f"followed to its end: {end}"
            )
    return system, branch


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
            f"the branch from {str(branch.start)!r} to {str(branch.end)!r} has no "
            f"{PERIOD_DOUBLING if nodes else SADDLE_NODE} to bound its stable range"
        )
    doubling = doublings[0]
    return {
        SADDLE_NODE: branch.special[node].point,
        PERIOD_DOUBLING: branch.special[doubling].point,
    }


# What is published of special orbits.
_PLACE = ("amplitude", "phase", "contact_duration")


class _Row(NamedTuple):
    """One branch: columns along it, its special points, and why it ends."""

    columns: dict[str, np.ndarray]
    kinds: list[str]
    special: dict[str, np.ndarray]
    reasons: list[str]


def _along(orbit: Orbit) -> dict[str, np.ndarray]:
    """What is published of the orbits of a branch."""
    floquet = orbit.multipliers()
    return {
        **columns(orbit, "amplitude", *OBSERVED),
        "multiplier_real": floquet.real,
        "multiplier_imag": floquet.imag,
        "residual": orbit.defect(),
    }


def _places(orbit: Orbit) -> dict[str, np.ndarray]:
    """Where special orbits are."""
    return {**{name: getattr(orbit, name) for name in _PLACE}, "residual": orbit.defect()}


def _row(
    ratio: float, parameters: Mapping[str, Any], release: str, settings: Mapping[str, Any]
) -> _Row:
    """The branch of one contact; NaN, with the reason, where it cannot be followed."""
    n, count, top = parameters["n"], parameters["points"], parameters["amplitude_max"]
    _, newton = controls(settings)
    try:
        system, branch = branch_along_amplitude(
            n, parameters["restitution"], ratio, top, release, settings
        )
        y = resample(system, branch, count, newton)
    except (NoOrbitError, ContinuationError) as error:
        none = _missing(n, count)
        return _Row(_along(none), [], _places(none[:0]), [str(error)] * 2)
    chosen = [s for s in branch.special if s.name in (SADDLE_NODE, PERIOD_DOUBLING)]
    grazing = grazing_points(system, lambda z: system.orbit(z).is_admissible(), y, newton)
    points = np.array([*(s.point for s in chosen), *grazing]).reshape(-1, y.shape[-1])
    return _Row(
        _along(system.orbit(y)),
        [*(s.name for s in chosen), *[GRAZING] * len(grazing)],
        _places(system.orbit(points)),
        [str(branch.start), str(branch.end)],
    )


def _missing(n: int, count: int) -> Orbit:
    """Orbits that do not exist."""
    return SpringDamperModel(SpringDamper(1.0, 0.0)).system(n).orbit(np.full((count, 4), np.nan))


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
    ratios = np.array(parameters["frequency_ratio"], dtype=float)
    rows = [_row(ratio, parameters, release, settings) for ratio in ratios]
    dims, special = ("frequency_ratio", "point"), ("frequency_ratio", "special")
    dataset = xr.Dataset(coords={"frequency_ratio": ratios})
    for name in rows[0].columns:
        own = (*dims, "multiplier") if name.startswith("multiplier") else dims
        dataset[name] = (own, np.array([row.columns[name] for row in rows]))
    dataset["special_kind"] = (special, _ragged([row.kinds for row in rows], ""))
    for name in rows[0].special:
        dataset[f"special_{name}"] = (special, _ragged([row.special[name] for row in rows]))
    dataset["end_reason"] = (("frequency_ratio", "end"), np.array([row.reasons for row in rows]))
    return describe(dataset.assign_coords(end=["unstable side", "stable side"]))


def both_domains(
    parameters: Mapping[str, Any], release: str, settings: Mapping[str, Any]
) -> xr.Dataset:
    """The branch of one ϖ beside that of the restitution model (Fig. 15)."""
    n, r, top = parameters["n"], parameters["restitution"], parameters["amplitude_max"]
    contact = orbit_branches(
        {**parameters, "frequency_ratio": [parameters["frequency_ratio"]]}, release, settings
    )
    model = RestitutionModel(r)
    rigid = model.orbit_of(n, *restitution_orbits.branch(n, r, top, parameters["points"]))
    node, doubling = model.saddle_node(n), model.period_doubling(n)
    return describe(
        contact.assign(
            restitution_amplitude=("point", rigid.amplitude),
            restitution_phase=("point", rigid.phase),
            restitution_stable=("point", rigid.is_stable()),
            restitution_admissible=("point", rigid.is_admissible()),
            saddle_node_amplitude=((), float(node.amplitude)),
            saddle_node_phase=((), float(node.phase)),
            period_doubling_amplitude=((), float(doubling.amplitude)),
            period_doubling_phase=((), float(doubling.phase)),
        )
    )


def printed_ranges(printed: Mapping[str, Any], ratios: list, families: list) -> np.ndarray:
    """A printed table at the frequency ratios and families computed, shape (ϖ, n, 2).

    NaN where the paper has no entry.

    Examples
    --------
    >>> printed = {"frequency_ratio": [10.0], "n": [1], "bound": ["saddle-node",
    ...            "period doubling"], "values": [[[0.25, 1.0]]]}
    >>> printed_ranges(printed, [10.0, 5.0], [1]).tolist()
    [[[0.25, 1.0]], [[nan, nan]]]
    """
    axes = {key: printed[key] for key in ("frequency_ratio", "n", "bound")}
    table = xr.DataArray(printed["values"], axes)
    wanted = {"frequency_ratio": ratios, "n": families, "bound": [SADDLE_NODE, PERIOD_DOUBLING]}
    return table.reindex(wanted).values


def _limits(
    n: int, ratio: float, parameters: Mapping[str, Any], release: str, settings: Mapping[str, Any]
) -> tuple[Orbit, str]:
    """The orbits at both ends of the stable range, or NaN and why there is none."""
    r, top = parameters["restitution"], parameters["amplitude_max"]
    try:
        system, branch = branch_along_amplitude(n, r, ratio, top, release, settings)
        ends = first_limits(branch)
    except (NoOrbitError, ContinuationError) as error:
        return _missing(n, 2), str(error)
    return system.orbit(np.array([ends[SADDLE_NODE], ends[PERIOD_DOUBLING]])), ""


def stability_ranges(
    parameters: Mapping[str, Any],
    release: str,
    settings: Mapping[str, Any],
    printed: Mapping[str, Any],
) -> xr.Dataset:
    """Ranges of Λ in which the n-T orbits are stable, computed and printed (Table 1).

    Where an orbit has no such range the entry is NaN, and ``absence`` says why.
    """
    families, r = np.array(parameters["n"]), parameters["restitution"]
    ratios = np.array(parameters["frequency_ratio"], dtype=float)
    found = [
        [_limits(int(n), ratio, parameters, release, settings) for n in families]
        for ratio in ratios
    ]
    rigid = RestitutionModel(r).saddle_node(families).amplitude
    maps = list(restitution_orbits.ImpactMap)
    doublings = [restitution_orbits.period_doubling(families, r, kind) for kind in maps]
    dims = ("frequency_ratio", "n", "bound")
    columns = {
        name: np.array([[getattr(orbit, name) for orbit, _ in row] for row in found])
        for name in _PLACE
    }
    reasons = np.array([[reason for _, reason in row] for row in found])
    dataset = xr.Dataset(
        {
            "computed": (dims, columns["amplitude"]),
            "special_phase": (dims, columns["phase"]),
            "special_contact_duration": (dims, columns["contact_duration"]),
            "printed": (
                dims,
                printed_ranges(printed, parameters["frequency_ratio"], parameters["n"]),
            ),
            "restitution_range": (
                ("impact_map", "n", "bound"),
                np.array([np.stack([rigid, doubling], axis=-1) for doubling in doublings]),
            ),
        },
        coords={
            "frequency_ratio": ratios,
            "n": families,
            "bound": [SADDLE_NODE, PERIOD_DOUBLING],
            "impact_map": [str(kind) for kind in maps],
        },
    )
    if np.any(reasons != ""):
        dataset["absence"] = (dims[:2], reasons)
    return describe(dataset)
