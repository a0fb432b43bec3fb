"""Check of the configuration, with one line per mistake.

The type of each section is that of the ``parameters`` of the study which takes it. So what is
allowed, and why, stands beside the study.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from pydantic import BaseModel, ValidationError, create_model

from bouncing_ball.atlas.plan import AtlasParameters
from bouncing_ball.configuration.study import SECTIONS, section, taken
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.parameters import Parameters


class _Sections(Parameters, strict=False):
    """The whole configuration, whose release rule is written as a text."""


def configuration_model(studies: Mapping[str, str], config: Mapping[str, Any]) -> type[BaseModel]:
    """The type of the whole configuration.

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
    keys: dict[str, Any] = {"atlas": (AtlasParameters, ...)}
    for artifact, study in sorted(studies.items()):
        for name, kind in taken(study).items():
            if name == "parameters":
                where, key = section(artifact, config)
                places[where][key] = (kind, ...)
            else:
                keys[name] = (kind, ...)
    for name, fields in places.items():
        keys[name] = (create_model(name, __base__=Parameters, **fields), ...)
    return create_model("Configuration", __base__=_Sections, **keys)


def check_configuration(
    files: Iterable[str], config: Mapping[str, Any], studies: Mapping[str, str]
) -> None:
    """Raise on the first mistake in the files of a run, or in what it has read of them.

    Raises
    ------
    ConfigurationError
        One line that names the file, or the key.
    """
    for where in files:
        try:
            # Snakemake has read it already, and taken the last of equal keys.
            read_yaml(where)
        except ConfigurationError as error:
            raise ConfigurationError(f"{where}: {error}") from None
    try:
        model = configuration_model(studies, config)
        check(model, config, release=config.get("release"))
    except ConfigurationError as error:
        raise ConfigurationError(f"configuration: {error}") from None


def check(model: type[BaseModel], config: Mapping[str, Any], **context: Any) -> None:
    """Raise on the first mistake.

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
        model.model_validate(config, context=context)
    except ValidationError as error:
        # A mistyped key is missing as well: what is unknown says more.
        first = min(error.errors(), key=lambda each: each["type"] != "extra_forbidden")
        raise ConfigurationError(_sentence(model, first)) from None


def place(path: Sequence[str | int]) -> str:
    """A place of the configuration in words.

    Examples
    --------
    >>> place(("figures", "fig08", "frequency_ratio", 0))
    'figures.fig08.frequency_ratio[0]'
    """
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def resolved(schema: Mapping[str, Any], root: Mapping[str, Any]) -> dict[str, Any]:
    """A JSON schema with what it refers to filled in; its own entries win.

    Examples
    --------
    >>> root = {"$defs": {"Span": {"type": "object", "description": "a grid"}}}
    >>> resolved({"$ref": "#/$defs/Span", "description": "two grids"}, root)
    {'type': 'object', 'description': 'two grids'}
    """
    reference = schema.get("$ref", "").removeprefix("#/$defs/")
    own = {key: part for key, part in schema.items() if key != "$ref"}
    return {**(root["$defs"][reference] if reference else {}), **own}


_MUST = {
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "finite_number": "must be a finite number",
    "too_short": "must have at least {min_length} items",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "tuple_type": "must be a list",
    "enum": "must be {expected}",
    "literal_error": "must be {expected}",
}


def _sentence(model: type[BaseModel], error: Any) -> str:
    """What is wrong, where, what is allowed, and why."""
    where = error["loc"]
    root = model.model_json_schema()
    schema = parent = resolved(root, root)
    for part in where:
        parent = schema
        inner = schema.get("items", {}) if isinstance(part, int) else schema["properties"].get(part)
        schema = resolved(inner or {}, root)
    kind, value, name = error["type"], error["input"], place(where)
    if kind == "extra_forbidden":
        known = list(parent["properties"])
        close = get_close_matches(str(where[-1]), known, n=1)
        meant = f", did you mean {close[0]}?" if close else "."
        allowed = f"{meant} Allowed here: {', '.join(known)}"
        return f"unknown key {name} = {_shown(value)}{allowed}"
    if kind == "missing":
        return f"missing key {name}: {schema.get('description', schema.get('title'))}"
    context = error.get("ctx", {})
    if kind == "value_error":
        text = str(context["error"])
        return f"{name} = {_shown(value)} {text}" if text.startswith("must") else f"{name}: {text}"
    if kind.startswith("model"):
        must = f"must be a mapping of the keys {', '.join(schema.get('properties', {}))}"
    else:
        must = _MUST[kind].format(**context) if kind in _MUST else error["msg"]
    notes = [schema["description"]] if "description" in schema else []
    if isinstance(value, str) and re.fullmatch(r"[-+]?\d+\.?\d*[eE][-+]?\d+", value):
        notes.insert(0, "powers of ten are written 1.0e+4, with point and sign")
    return f"{name} = {_shown(value)} {must}" + (f" ({'; '.join(notes)})" if notes else "")


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
