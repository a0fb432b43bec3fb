"""Orbits in datasets, from which they come back with the same bits.

A dataset of orbits has the fields of :class:`~bouncing_ball_beyond.periodic.orbits.orbit.Orbit` as
variables: ``amplitude``, ``turns``, ``phase``, ``impact_velocity``, ``contact_duration`` and
``resumes``, and in ``ball_model`` the model as text (:mod:`bouncing_ball_beyond.models.as_text`).
Parameters of the model that differ from orbit to orbit are variables too. The special orbits of a
branch are in variables with the prefix ``special_``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond.drawing.result import Result
from bouncing_ball_beyond.inherited.datasets.arguments import (
    SAMPLES,
    checked_number,
    require_memory,
)
from bouncing_ball_beyond.inherited.datasets.variables import SHARED, Variable, describe
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.as_text import model_of, text_of
from bouncing_ball_beyond.periodic.orbits.impacts import OrbitImpacts
from bouncing_ball_beyond.periodic.orbits.motion import path, touches

ORBIT = "orbit"
"""The dimension of several orbits that are no branch."""
MOVED = "moved"
"""The attribute with the parameters that change along the path of a user, which has no name in its
orbits."""
KEPT = {
    "ball_model": Variable("model of the impact with its parameters, as text"),
    "turns": Variable("whole turns of the table from the impact to the next one, see Orbit.turns"),
    "resumes": Variable("whether the contact resumes below the level of the table"),
    "special_turns": Variable("whole turns of the table at the special point"),
    "special_impact_velocity": Variable("absolute velocity before impact at the special point"),
    "impact": Variable("number of the impact within the orbit"),
    ORBIT: Variable("number of the orbit"),
}
"""What is kept beside the quantities of orbits."""
_FIELDS = {
    "phase": "phases",
    "impact_velocity": "velocities",
    "contact_duration": "durations",
    "turns": "turns",
}


def columns_of(orbit: OrbitImpacts, over: str, prefix: str = "") -> dict[str, Any]:
    """The fields of orbits, a row of them over a dimension, as variables with this prefix.

    A single orbit has no such dimension.
    """
    leading = (over,) if orbit.shape else ()
    whole = (*orbit.shape, orbit.impacts)
    text, arrays = text_of(orbit.model)
    found: dict[str, Any] = {
        prefix + name: (
            (*leading, "impact"),
            np.array(np.broadcast_to(getattr(orbit, field), whole)),
        )
        for name, field in _FIELDS.items()
    }
    for name, values in {"amplitude": np.asarray(orbit.amplitude), **arrays}.items():
        found[prefix + name] = leading if values.ndim else (), values
    resumes = np.array(np.broadcast_to(orbit.resumes, (orbit.impacts,)))
    return found | {"ball_model": ((), text), "resumes": ("impact", resumes)}


def dataset_of(orbit: OrbitImpacts) -> xr.Dataset:
    """One orbit, or a row of orbits, as a labelled dataset; see :meth:`.Orbit.to_dataset`."""
    if len(orbit.shape) > 1:
        raise ModelError(f"orbits of the shape {orbit.shape} are not in a row: give a part of them")
    columns = columns_of(orbit, ORBIT)
    data = xr.Dataset(columns | {"kind": ((), orbit.kind)})
    names = [str(name) for name in data]
    named = {name: SHARED.get(name, Variable(name.replace("_", " "))) for name in names}
    named["kind"] = Variable("kind of special orbit")
    return describe(data, named | KEPT).assign_attrs(along=", ".join(orbit.along))


def history_of(orbit: OrbitImpacts, samples: int) -> Result:
    """A single orbit over one repetition; see :meth:`.Orbit.history`."""
    if orbit.shape or not orbit.exists:
        raise ModelError("a history is that of one orbit that exists: give one of the orbits")
    count = checked_number("samples", samples, SAMPLES)
    time = np.linspace(0.0, 2 * np.pi * int(orbit.periods), int(orbit.periods) * count + 1)
    require_memory(time.size, "states", "samples")
    height, velocity = path(orbit, time)
    table = orbit.amplitude * np.sin(orbit.phases[0] + time)
    columns = {"ball": height, "ball_velocity": velocity, "table": table}
    columns["contact"] = touches(orbit, time)
    data = xr.Dataset({name: ("time", values) for name, values in columns.items()}, {"time": time})
    labels = dict(orbit.model.parameters) | {"amplitude": orbit.amplitude}
    return Result.of(describe(data).assign_attrs(labels), "history")


def has_orbits(data: xr.Dataset, prefix: str = "") -> bool:
    """Whether a dataset has all that orbits need, with their model as one text."""
    needed = {"ball_model", "resumes", *(prefix + name for name in _FIELDS)}
    return needed <= set(data.variables)


def fields_in(data: xr.Dataset, prefix: str = "") -> dict[str, Any]:
    """The fields of the orbits in variables of this prefix, of a row or of a single one.

    Raises
    ------
    ModelError
        If the dataset has no orbits, or if the law is not known.
    """
    if not has_orbits(data, prefix):
        needed = ["ball_model", "resumes", *(prefix + name for name in _FIELDS)]
        missing = [name for name in needed if name not in data.variables]
        raise ModelError(f"the dataset has no orbits: it lacks {', '.join(missing)}")
    if data["ball_model"].ndim:
        names = ", ".join(map(str, data["ball_model"].dims))
        raise ModelError(f"these are orbits of several balls: select one of {names} with isel")
    values: dict[str, np.ndarray] = {}
    for name, field in _FIELDS.items():
        variable = data[prefix + name]
        row = variable.values
        values[field] = row if "impact" in variable.dims else row[..., np.newaxis]
    given = {name: data[prefix + name].values for name in _names_of(data, prefix)}
    amplitude = given.pop("amplitude", data.attrs.get("amplitude"))
    if amplitude is None:
        raise ModelError("the dataset has no orbits: amplitude is missing")
    along = str(data.attrs.get(MOVED, data.attrs.get("along", "amplitude")))
    return {
        "model": model_of(str(data["ball_model"].item()), given),
        "amplitude": np.asarray(amplitude) if np.ndim(amplitude) else float(amplitude),
        "turns": values["turns"].astype(int),
        "phases": reduce_angle(values["phases"]),
        "velocities": values["velocities"],
        "durations": values["durations"],
        "resumes": np.atleast_1d(data["resumes"].values),
        "kind": str(data["kind"].item()) if "kind" in data else "",
        "along": tuple(along.split(", ")),
    }


def _names_of(data: xr.Dataset, prefix: str) -> list[str]:
    """The names of the variables of this prefix, without the prefix."""
    names = [str(name) for name in data.variables]
    return [name.removeprefix(prefix) for name in names if name.startswith(prefix)]
