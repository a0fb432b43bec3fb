"""The check of the configuration, with one line per mistake.

The type of each section is that of the ``parameters`` of the study which takes it, so that the
allowed values and the reasons for them stand beside the study.
"""

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from pydantic import BaseModel, ValidationError, create_model

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.configuration.study import SECTIONS, section, taken
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.errors import printable
from bouncing_ball.parameters import Parameters


class _Sections(Parameters, strict=False):
    """The complete configuration, in which the release rule is a text."""


def configuration_model(studies: Mapping[str, str], config: Mapping[str, Any]) -> type[BaseModel]:
    """The type of the complete configuration.

    Parameters
    ----------
    studies : mapping
        The study of each artifact.
    config : mapping
        The configuration, which says in which section an artifact is.

    Raises
    ------
    ConfigurationError
        If a study is missing, or the parameters of an artifact.
    """
    places: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    keys: dict[str, Any] = {"atlas": (Plan, ...)}
    for artifact, study in sorted(studies.items()):
        for name, kind in taken(study).items():
            if name == "parameters":
                places[section(artifact, config)][artifact] = (kind, ...)
            else:
                keys[name] = (kind, ...)
    for name, fields in places.items():
        keys[name] = (create_model(name, __base__=Parameters, **fields), ...)
    return create_model("Configuration", __base__=_Sections, **keys)


def check_configuration(
    files: Iterable[str], config: Mapping[str, Any], studies: Mapping[str, str]
) -> None:
    """Raise on the first mistake in the files of a run, or in the configuration read from them.

    Raises
    ------
    ConfigurationError
        One line that names the file, or the key.
    """
    for where in files:
        try:
            # Snakemake has read it already, but takes the last of equal keys without an error.
            read_yaml(where)
        except ConfigurationError as error:
            raise ConfigurationError(f"{where}: {error}") from None
    try:
        check(configuration_model(studies, config), config)
    except ConfigurationError as error:
        raise ConfigurationError(f"configuration: {error}") from None


def check(model: type[BaseModel], config: Mapping[str, Any]) -> None:
    """Raise on the first mistake in a configuration of this type.

    Raises
    ------
    ConfigurationError
        One line that names the key, the value and what is allowed.

    Examples
    --------
    >>> from bouncing_ball.parameters import Span
    >>> check(Span, {"min": 1.0, "max": 2.0, "sample": 3})
    Traceback (most recent call last):
    ...
    bouncing_ball.configuration.yaml_file.ConfigurationError: unknown key sample = 3, did you mean \
samples? Allowed here: min, max, samples
    """
    try:
        model.model_validate(config)
    except ValidationError as error:
        # A mistyped key is reported as unknown and as missing, of which the first is clearer.
        first = min(error.errors(), key=lambda each: each["type"] != "extra_forbidden")
        raise ConfigurationError(_sentence(model, first)) from None


def place(path: Sequence[str | int]) -> str:
    """The name of a place in the configuration.

    Examples
    --------
    >>> place(("figures", "fig08", "frequency_ratio", 0))
    'figures.fig08.frequency_ratio[0]'
    """
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def resolved(schema: Mapping[str, Any], root: Mapping[str, Any]) -> dict[str, Any]:
    """A JSON schema in which a reference is replaced by its target; entries beside it take
    precedence.

    Examples
    --------
    >>> root = {"$defs": {"Span": {"type": "object", "description": "a grid"}}}
    >>> resolved({"$ref": "#/$defs/Span", "description": "two grids"}, root)
    {'type': 'object', 'description': 'two grids'}
    """
    reference = schema.get("$ref", "").removeprefix("#/$defs/")
    own = {key: part for key, part in schema.items() if key != "$ref"}
    return {**(root["$defs"][reference] if reference else {}), **own}


# Expressions of pydantic, and what a user of YAML reads instead.
_WORDS = {
    "Input should": "must",
    "Tuple should": "must",
    "greater than or equal to": "at least",
    "less than or equal to": "at most",
    "a valid tuple": "a list",
    "a valid integer": "a whole number",
    "a valid number": "a number (powers of ten are written 1.0e+4, with point and sign)",
}


def _sentence(model: type[BaseModel], error: Any) -> str:
    """One sentence for an error: the place, the value, what is allowed, and why."""
    root = model.model_json_schema()
    schema = parent = resolved(root, root)
    for part in error["loc"]:
        parent, inner = schema, schema.get("items" if isinstance(part, int) else "properties", {})
        schema = resolved(inner if isinstance(part, int) else inner.get(part, {}), root)
    kind, name, description = error["type"], place(error["loc"]), schema.get("description")
    given = f"{name} = {printable(repr(error['input']), 60)}"
    if kind == "extra_forbidden":
        known = list(parent["properties"])
        close = get_close_matches(str(error["loc"][-1]), known, n=1)
        meant = f", did you mean {close[0]}?" if close else "."
        return f"unknown key {given}{meant} Allowed here: {', '.join(known)}"
    if kind == "missing":
        return f"missing key {name}: {description or schema.get('title')}"
    if kind == "value_error":
        text = str(error["ctx"]["error"])
        return f"{given} {text}" if text.startswith("must") else f"{name}: {text}"
    text = error["msg"]
    if kind.startswith("model"):
        text = f"must be a mapping of the keys {', '.join(schema['properties'])}"
    for theirs, ours in _WORDS.items():
        text = text.replace(theirs, ours)
    return f"{given} {text}" + (f" ({description})" if description else "")
