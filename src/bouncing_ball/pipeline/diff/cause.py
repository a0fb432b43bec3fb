"""Why an artifact differs from the record, as far as the two files themselves say it.

Every dataset has the parameters among its attributes, and every dataset and picture its provenance:
the digests of the code that made it, the versions of the libraries, and the files it was made from.
The causes are named in this order: other parameters, other code, other versions of the libraries
that compute and draw, and other inputs. If there is none of these, the numbers have moved.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.artifacts import DATASET
from bouncing_ball.pipeline.provenance import PREFIX, parameters_of, read_attributes
from bouncing_ball.pipeline.sources import changed_files

_LIBRARIES = ("numpy", "scipy", "matplotlib")
# More names of artifacts or files than these are counted.
_NAMED = 4


class ParameterChange(NamedTuple):
    """A parameter with its value in the record and the new one, as texts."""

    name: str
    record: str
    new: str


def _nested(value: Any) -> Any:
    """The value of an attribute; a list of anything but numbers is stored as JSON."""
    if isinstance(value, str) and value.startswith("["):
        return json.loads(value)
    return value


def _flat(name: str, value: Any) -> dict[str, Any]:
    """A parameter by its name in the configuration, with an entry for each part of a case.

    Examples
    --------
    >>> _flat("cases", '[{"restitution": 1.0, "amplitude": 0.8}]')
    {'cases[0].restitution': 1.0, 'cases[0].amplitude': 0.8}
    >>> _flat("frequency_ratio__min", 0.5), _flat("n", [1, 2])
    ({'frequency_ratio.min': 0.5}, {'n': [1, 2]})
    """
    name = name.replace("__", ".")
    value = _nested(value)
    if isinstance(value, list) and any(isinstance(case, Mapping) for case in value):
        return {
            f"{name}[{index}].{key}": part
            for index, case in enumerate(value)
            for key, part in case.items()
        }
    return {name: value}


def parameter_changes(record: Mapping[Any, Any], new: Mapping[Any, Any]) -> list[ParameterChange]:
    """The parameters that differ between two datasets, given those of each by name.

    Examples
    --------
    >>> for change in parameter_changes({"restitution": 0.85, "n": 1}, {"restitution": 0.7}):
    ...     print(*change)
    restitution 0.85 0.7
    n 1 none
    """
    old, now = (_all_flat(parameters) for parameters in (record, new))
    names = [name for name in {**old, **now} if repr(old.get(name)) != repr(now.get(name))]
    return [ParameterChange(name, *_texts(old.get(name), now.get(name))) for name in names]


def _all_flat(parameters: Mapping[Any, Any]) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in parameters.items():
        flat |= _flat(name, value)
    return flat


def _texts(record: Any, new: Any) -> tuple[str, str]:
    """Two values as texts; a number and its text have quotation marks to tell them apart."""
    shown = str if str(record) != str(new) else repr
    old_text, new_text = ("none" if value is None else shown(value) for value in (record, new))
    return old_text, new_text


@dataclass(frozen=True)
class Origin:
    """How an artifact was made, from its attributes; an entry is empty if it is not recorded.

    Parameters
    ----------
    parameters : mapping
        The parameters of a dataset by name; a picture has none.
    code : str
        Digests of the files of code that made it, see :func:`~.sources.digests`.
    versions : mapping
        Versions of the libraries by name.
    inputs : tuple of str
        The files that it is made from, as paths relative to the repository.
    """

    parameters: Mapping[str, Any]
    code: str
    versions: Mapping[str, str]
    inputs: tuple[str, ...]


UNKNOWN_ORIGIN = Origin({}, "", {}, ())


def require_origin(path: Path) -> Origin:
    """The origin of a dataset or a picture, unknown if there is no such file.

    Raises
    ------
    ModelError
        If the file cannot be read, or its provenance is damaged.
    """
    if not path.exists():
        return UNKNOWN_ORIGIN
    attributes = read_attributes(path)
    try:
        versions = dict(json.loads(attributes.get(f"{PREFIX}versions", "{}")))
        inputs = [str(name) for name in json.loads(attributes.get(f"{PREFIX}inputs", "[]"))]
    except (TypeError, ValueError):
        raise ModelError(f"{path}: its provenance is damaged") from None
    return Origin(
        parameters=parameters_of(attributes) if path.suffix == DATASET else {},
        code=str(attributes.get(f"{PREFIX}code", "")),
        versions=versions,
        inputs=tuple(inputs),
    )


def origin_of(path: Path) -> Origin:
    """The origin of a dataset or a picture, unknown if the file cannot be read."""
    try:
        return require_origin(path)
    except ModelError:
        return UNKNOWN_ORIGIN


def code_changes(record: Origin, new: Origin) -> tuple[str, ...]:
    """The files of code that made an artifact and that differ; empty if they are not recorded.

    Examples
    --------
    >>> code_changes(Origin({}, "1f0e a.py", {}, ()), Origin({}, "2a2a a.py", {}, ()))
    ('a.py',)
    """
    if not record.code or not new.code:
        return ()
    return tuple(changed_files(record.code, new.code))


def own_causes(record: Origin, new: Origin) -> list[str]:
    """The causes that lie in the making of an artifact itself, the most important one first.

    Examples
    --------
    >>> record = Origin({"restitution": 0.85}, "1f0e a.py", {"numpy": "2.2.0"}, ())
    >>> new = Origin({"restitution": 0.7}, "2a2a a.py", {"numpy": "2.3.1"}, ())
    >>> own_causes(record, new)
    ['parameter changed, restitution 0.85 → 0.7', 'other code, a.py', 'other numpy, 2.2.0 → 2.3.1']
    """
    causes = []
    if changes := parameter_changes(record.parameters, new.parameters):
        subject = "parameter" if len(changes) == 1 else "parameters"
        values = [f"{change.name} {change.record} → {change.new}" for change in changes]
        causes.append(f"{subject} changed, {', '.join(values)}")
    if record.code and new.code and record.code != new.code:
        files = code_changes(record, new)
        causes.append(f"other code, {_some(files)}" if files else "other code")
    for name in _LIBRARIES:
        old_version = record.versions.get(name)
        new_version = new.versions.get(name)
        if old_version and new_version and old_version != new_version:
            causes.append(f"other {name}, {old_version} → {new_version}")
    return causes


def made_from(names: Sequence[str]) -> str:
    """The cause that lies in other artifacts, with the names of the first of them.

    Examples
    --------
    >>> made_from(["fig14"]), made_from(["fig05", "fig06", "fig08", "fig09", "fig10"])
    ('made from fig14', 'made from fig05, fig06, fig08, fig09 and 1 more')
    """
    return f"made from {_some(names)}"


def _some(names: Sequence[str]) -> str:
    """The first names, and how many there are more."""
    more = len(names) - _NAMED
    rest = f" and {more} more" if more > 0 else ""
    return f"{', '.join(names[:_NAMED])}{rest}"
