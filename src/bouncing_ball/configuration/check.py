"""The check of the configuration, with one line per mistake.

The type of each section is that of the argument ``parameters`` of its study, so that the allowed
values and the reasons for them are defined beside the study.
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
    """Base of the complete configuration; it converts values, because YAML has no release rules."""


def configuration_model(studies: Mapping[str, str], config: Mapping[str, Any]) -> type[BaseModel]:
    """The type of the complete configuration.

    Parameters
    ----------
    studies : mapping
        The study of each artifact.
    config : mapping
        The configuration, from which follows the section of each artifact.

    Raises
    ------
    ConfigurationError
        If a study, or the parameters of an artifact, are missing, or if a key of the configuration
        that is no section is wrong.
    """
    arguments = {artifact: taken(study) for artifact, study in sorted(studies.items())}
    keys: dict[str, Any] = {"atlas": (Plan, ...)}
    for each in arguments.values():
        keys |= {name: (kind, ...) for name, kind in each.items() if name != "parameters"}
    known: dict[str, Any] = dict.fromkeys(arguments, (Any, None))
    keys |= {name: (create_model(name, __base__=Parameters, **known), ...) for name in SECTIONS}
    # The section of an artifact is known only if all sections are there. A mistyped artifact is
    # named here, before another one is found to be missing.
    check(create_model("Configuration", __base__=_Sections, **keys), config)
    places: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    for artifact, each in arguments.items():
        if "parameters" in each:
            places[section(artifact, config)][artifact] = (each["parameters"], ...)
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
        The message is one line that names the file or the key.
    """
    for where in files:
        try:
            # Snakemake has read the file already, but accepts duplicate keys without an error.
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
        The message is one line that names the key, the value and the allowed values.

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
        # Pydantic reports a mistyped key as unknown and as missing; the first report is clearer.
        first = min(error.errors(), key=lambda each: each["type"] != "extra_forbidden")
        raise ConfigurationError(_sentence(model, first)) from None


def place(path: Sequence[str | int]) -> str:
    """A path of keys and indices in the configuration, as text.

    Examples
    --------
    >>> place(("figures", "fig08", "frequency_ratio", 0))
    'figures.fig08.frequency_ratio[0]'
    """
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def resolved(schema: Mapping[str, Any], root: Mapping[str, Any]) -> dict[str, Any]:
    """A JSON schema whose reference is replaced by its target.

    Entries beside the reference take precedence over those of the target.

    Examples
    --------
    >>> root = {"$defs": {"Span": {"type": "object", "description": "a grid"}}}
    >>> resolved({"$ref": "#/$defs/Span", "description": "two grids"}, root)
    {'type': 'object', 'description': 'two grids'}
    """
    reference = schema.get("$ref", "").removeprefix("#/$defs/")
    own = {key: part for key, part in schema.items() if key != "$ref"}
    return {**(root["$defs"][reference] if reference else {}), **own}


# Expressions in the messages of pydantic, and the words for users of YAML in their place.
_WORDS = {
    "Input should": "must",
    "Tuple should": "must",
    "greater than or equal to": "at least",
    "less than or equal to": "at most",
    "a valid tuple": "a list",
    "a valid dictionary": "a mapping",
    "a valid integer": "a whole number",
    "a valid number": "a number (powers of ten are written 1.0e+4, with point and sign)",
}


def _sentence(model: type[BaseModel], error: Any) -> str:
    """One sentence for an error: the place, the value, the allowed values, and the reason."""
    root = model.model_json_schema()
    schema = parent = resolved(root, root)
    for part in error["loc"]:
        parent, inner = schema, schema.get("items" if isinstance(part, int) else "properties", {})
        schema = resolved(inner if isinstance(part, int) else inner.get(part, {}), root)
    kind, name = error["type"], place(error["loc"])
    description = " ".join(schema.get("description", "").split())
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
