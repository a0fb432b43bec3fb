"""Convert orbits, branches and curves to labelled datasets, and restore them."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import fields, replace
from os import PathLike
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond import named_laws
from bouncing_ball_beyond.balls import Ball, Corrected, Rigid, SpringDamper, brief
from bouncing_ball_beyond.branches import FollowedBranch, SpecialCurve
from bouncing_ball_beyond.equations import OrbitEquations, row_of
from bouncing_ball_beyond.laws import ForceLaw
from bouncing_ball_beyond.paths import OF_TABLES, Path, path_of
from bouncing_ball_beyond.periodic import PeriodicOrbit
from bouncing_ball_beyond.rests import RestEquations, RestOrbit
from bouncing_ball_beyond.tables import SINE, Table

OF_IMPACTS = {
    "phase": ("phase of the table as an impact starts", "φ", "rad"),
    "release_phase": ("phase of the table at the end of the contact", "φ + D", "rad"),
    "contact_duration": ("duration of the contact", "D", "1"),
    "flight_time": ("duration of the flight after the contact", "", "1"),
    "impact_velocity": ("velocity of the ball as an impact starts", "", "1"),
    "bounce_velocity": ("velocity of the ball as the contact ends", "", "1"),
    "relative_impact_velocity": ("relative velocity as an impact starts", "δ′", "1"),
    "relative_bounce_velocity": ("relative velocity as the contact ends", "δ′", "1"),
    "apparent_restitution": ("apparent restitution coefficient", "rₐ", "1"),
}
"""Quantities of the impacts: long name, symbol and unit."""

OF_ORBITS = {
    "max_height": ("greatest height of the ball", "", "1"),
    "periods": ("periods of the table in one period of the orbit", "m", "1"),
    "stable": ("whether neighbouring motions stay near", "", "1"),
    "admissible": ("whether a ball follows the orbit", "", "1"),
    "digits_left": ("certain decimal places of times and speeds", "", "1"),
    "kind": ("kind of a special orbit, and empty for others", "", "1"),
}
"""Quantities of whole orbits."""

OF_EQUATIONS = {
    "multiplier_real": ("real part of the Floquet multiplier", "μ", "1"),
    "multiplier_imag": ("imag part of the Floquet multiplier", "μ", "1"),
    "impact_time": ("time of the impact", "τ", "1"),
    "lift_off_time": ("time at which the ball leaves the table after a rest", "τ₀", "1"),
    "rest": ("how long the ball rests on the table", "", "1"),
    "scaled_duration": ("duration of the contact in the time of its equations", "T", "1"),
}
"""Unknowns and multipliers."""

PARAMETERS = {
    "amplitude": ("amplitude of the table", "Λ", "1"),
    "restitution": ("restitution coefficient", "r", "1"),
    "frequency_ratio": ("frequency ratio", "ϖ", "1"),
    "damping_ratio": ("damping ratio", "ζ", "1"),
    "frequency": ("frequency of a table with a fixed stroke", "Ω/√(g/a)", "1"),
}
"""Parameters. The long name of a parameter of a law is its name."""

BALLS: dict[str, Any] = {each.__name__: each for each in (Rigid, SpringDamper, Corrected, ForceLaw)}

LARGEST_DEFECT = 1e-6
"""Largest residual of a restored orbit. Orbits are found with residuals below 1e-7."""

Found = PeriodicOrbit | FollowedBranch | Sequence
"""Objects that datasets store: an orbit, a branch, a curve, or a list of orbits."""


# Datasets


def to_dataset(found: Found) -> xr.Dataset:
    """Convert an orbit, a branch, a curve or a list of orbits to a labelled dataset.

    Parameters
    ----------
    found : PeriodicOrbit, FollowedBranch, SpecialCurve or list of PeriodicOrbit
        The orbits of a list must vary the same parameter. They must have the same number of
        impacts, the same kind of ball and the same harmonics of the table. An `OrbitNotFound` is
        left out.

    Returns
    -------
    xarray.Dataset
        One row per orbit along ``point``. Quantities of impacts also have the axis ``impact``.
        Special orbits are between their neighbours on the branch, and have a ``kind``. Parameters
        are variables. The attributes of the dataset contain the ball and the table of the first
        orbit.

    Raises
    ------
    ValueError
        If there is no orbit, if ``found`` is a list of branches, or if the orbits of a list differ
        in kind.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> data = to_dataset(orbit(Rigid(0.5), amplitude=1.4))
    >>> round(data.impact_velocity.item(), 6), dict(data.sizes)
    (-3.141593, {'point': 1, 'impact': 1, 'multiplier': 2})
    """
    orbits = _listed(found)
    first = orbits[0]
    along = [path.name for path in first.equations.along]
    of_impacts = {
        name: [np.atleast_1d(getattr(each, name)) for each in orbits] for name in OF_IMPACTS
    }
    of_impacts["impact_time"] = [each.times for each in orbits]
    T = [each.scaled_durations for each in orbits]
    if np.size(T):
        of_impacts["scaled_duration"] = T
    of_orbits = {name: [getattr(each, name) for each in orbits] for name in OF_ORBITS}
    resting = [each for each in orbits if isinstance(each, RestOrbit)]
    if resting:
        of_orbits["lift_off_time"] = [each.z[each.equations.size - 1] for each in resting]
        of_orbits["rest"] = [each.rest for each in resting]
    of_orbits |= {name: [each.parameters[name] for each in orbits] for name in first.parameters}
    multipliers = np.array([each.multipliers for each in orbits])
    data = xr.Dataset(
        {
            **{name: (("point", "impact"), values) for name, values in of_impacts.items()},
            **{name: ("point", values) for name, values in of_orbits.items()},
            "multiplier_real": (("point", "multiplier"), multipliers.real),
            "multiplier_imag": (("point", "multiplier"), multipliers.imag),
        },
        attrs={
            "source": "bouncing_ball_beyond",
            "impacts": first.impacts,
            "ball": json.dumps(first.ball, default=encoded),
            "table": json.dumps(list(first.table.harmonics)),
            "along": json.dumps(along),
            "form": type(found).__name__,
        },
    )
    if isinstance(found, FollowedBranch):
        data.attrs |= {"start": found.start, "end": found.end}
    if isinstance(found, SpecialCurve):
        data.attrs["kind"] = found.kind
    texts = OF_IMPACTS | OF_ORBITS | OF_EQUATIONS | PARAMETERS
    for label, variable in data.items():
        text = texts.get(str(label), (str(label).replace("_", " "), "", "1"))
        variable.attrs.update(zip(("long_name", "symbol", "units"), text, strict=True))
    return data.set_coords(along)


def _listed(found: Found) -> list[PeriodicOrbit]:
    """Return all orbits in order, including the special orbits of a branch."""
    if isinstance(found, PeriodicOrbit):
        return [found]
    if isinstance(found, FollowedBranch):
        return found.with_special()
    several: list[Any] = list(found) if isinstance(found, Iterable) else [found]
    if any(isinstance(each, FollowedBranch) for each in several):
        raise ValueError(
            "a dataset stores one branch: write [to_dataset(branch) for branch in branches]"
        )
    orbits = [each for each in several if isinstance(each, PeriodicOrbit)]
    if not orbits:
        raise ValueError("there is no orbit to store: give an orbit, a branch or a list of orbits")
    if len({(type(each), type(each.ball), each.impacts, *each.parameters) for each in orbits}) > 1:
        raise ValueError(
            "the orbits of one dataset must vary the same parameter; they must have the same number"
            " of impacts, the same kind of ball and the same harmonics of the table"
        )
    return orbits


# Balls as texts


def encoded(value: Any) -> Any:
    """Encode a value for json: a ball by its class and fields, a function by its name."""
    if isinstance(value, Ball):
        ball: Any = value
        given = {field.name: getattr(ball, field.name) for field in fields(ball)}
        given = {name: each for name, each in given.items() if each is not None}
        return {"class": type(value).__name__, **given}
    if callable(value):
        name = getattr(value, "__name__", repr(value))
        return {"function": name, "named": getattr(named_laws, name, None) is value}
    return np.asarray(value).tolist()


def decoded(values: dict[str, Any]) -> Any:
    """Reverse :func:`encoded`. Raises ValueError if a function is not a named law."""
    if "function" in values:
        if not values["named"]:
            raise ValueError(
                f"the file does not contain the function {values['function']} of the ball: give"
                " the ball as ball="
            )
        return getattr(named_laws, values["function"])
    if "class" not in values:
        return values
    kind = BALLS[values.pop("class")]
    return kind(**{name: tuple(x) if isinstance(x, list) else x for name, x in values.items()})


def read_orbits(source: Any, *, ball: Ball | None = None) -> Found:
    """Restore orbits, a branch or a curve from a dataset of :func:`to_dataset`.

    Parameters
    ----------
    source : xarray.Dataset, str or path
        The dataset or its netCDF file.
    ball : Ball, optional
        The ball of the orbits. It is required if the ball contains a function that is not a named
        law, because datasets do not store functions.

    Returns
    -------
    PeriodicOrbit, FollowedBranch, SpecialCurve or list of PeriodicOrbit

    Raises
    ------
    ValueError
        If the dataset contains no orbits, if a required ball is missing, if the ball does not have
        the parameters of the dataset, or if the orbits are not orbits of the ball.

    Examples
    --------
    >>> from bouncing_ball_beyond import Rigid, orbit
    >>> one = orbit(Rigid(0.5), amplitude=1.4)
    >>> read_orbits(to_dataset(one)).distance(one)
    0.0
    """
    is_file = isinstance(source, str | PathLike)
    if not is_file and not isinstance(source, xr.Dataset):
        raise ValueError(f"source = {source!r}: must be a path or an xarray.Dataset")
    data = xr.load_dataset(source) if is_file else source
    name = f"{source}: " if is_file else ""
    if not {"ball", "along", "form"} <= data.attrs.keys():
        raise ValueError(
            f"{name}not a dataset of orbits: the attributes ball, along and form are missing; give"
            " a result of to_dataset"
        )
    ball = ball or json.loads(data.attrs["ball"], object_hook=decoded)
    # SINE has no parameters, so its dataset has no variables of a table.
    of_table = [name for name in map(str, data.variables) if name.startswith(OF_TABLES)]
    table = Table(json.loads(data.attrs["table"])) if of_table else SINE
    missing = ball.parameters.keys() - data.variables
    if missing:
        raise ValueError(
            f"{name}ball: its parameter {min(missing)} is not in the dataset; give the ball of the"
            " orbits as ball="
        )
    paths = [path_of(each, ball, table) for each in json.loads(data.attrs["along"])]
    numbers = range(data.sizes["point"])
    orbits = [_orbit_at(data.isel(point=i), ball, table, paths) for i in numbers]
    for each in orbits:
        if not each.defect < LARGEST_DEFECT:
            raise ValueError(
                f"{name}ball: {brief(ball)} does not follow the orbits of the dataset: the residual"
                f" of their equations is {each.defect:.3g}; give the ball of the orbits as ball="
            )
    form = data.attrs["form"]
    if form in ("PeriodicOrbit", "RestOrbit"):
        return orbits[0]
    if form not in ("FollowedBranch", "SpecialCurve"):
        return orbits
    common = data.attrs.get("kind", "")
    rows = [each for each in orbits if each.kind == common]
    equations = rows[0].equations
    special = tuple(replace(each, equations=equations) for each in orbits if each.kind != common)
    kind = SpecialCurve if common else FollowedBranch
    z = np.array([each.z for each in rows])
    ends = data.attrs["start"], data.attrs["end"]
    return kind(replace(equations, kind=common), z, special, *ends)


def _orbit_at(row: xr.Dataset, ball: Ball, table: Table, paths: list[Path]) -> PeriodicOrbit:
    """Restore the orbit of one row of a dataset."""
    T = row.get("scaled_duration")
    impacts = row.impact_time.values, -row.relative_impact_velocity.values, T
    here = ball.at(**{name: float(row[name]) for name in ball.parameters})
    given = row.sizes["impact"], int(row.periods), float(row.amplitude)
    on = table.at(**{name: float(row[name]) for name in table.parameters})
    values = [float(row[path.name]) for path in paths]
    kind = OrbitEquations
    if "lift_off_time" in row:
        kind = RestEquations
        values.insert(0, float(row.lift_off_time))
    equations = kind(here, *given, tuple(paths), on)
    return equations.orbit(row_of(ball, *impacts, *values), str(row.kind.values))
