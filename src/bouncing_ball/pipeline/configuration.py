"""Reading YAML files, with a message of one line for a mistake.

A duplicate key is an error, because otherwise the last value would be used without a warning.

The studies that the rules name, and the arguments that each takes from a run.

The signature of a study declares its arguments, for example ``study(parameters, release,
continuation)``. ``parameters`` is a section of the configuration, such as ``figures.fig08``;
``data`` holds the datasets that the rule names; ``part`` and ``found`` are those of
:mod:`bouncing_ball.datasets.shards`; and each further argument is the setting of the run with that
name.

The check of the configuration, with one line per mistake.

The type of each section is that of the argument ``parameters`` of its study, so that the allowed
values and the reasons for them are defined beside the study.
"""

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError, create_model, validate_call

from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.datasets.parameters import Parameters
from bouncing_ball.errors import ModelError, escaped, printable

# The loader of libyaml, where PyYAML was built with it, is ten times as fast. Both loaders read the
# same language.
_BASE = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class ConfigurationError(ModelError):
    """A wrong key, type or value in a file. The message is one line that is safe to print."""

    def __init__(self, text: str) -> None:
        super().__init__(escaped(text))


class _Loader(_BASE):  # type: ignore[misc, valid-type]
    """A loader of the safe subset of YAML that refuses duplicate keys in a mapping."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict:
        seen = set()
        for key, _ in node.value:
            if str(key.value) in seen:
                line = key.start_mark.line + 1
                raise ConfigurationError(f"duplicate key {key.value!r} in line {line}")
            seen.add(str(key.value))
        return super().construct_mapping(node, deep)


def parse_yaml(text: str) -> Any:
    """The content of a YAML text.

    Raises
    ------
    ConfigurationError
        If the text is not YAML or has a duplicate key.

    Examples
    --------
    >>> parse_yaml("{n: [1, 2], release: force}")
    {'n': [1, 2], 'release': 'force'}
    >>> parse_yaml("{n: 1, n: 2}")
    Traceback (most recent call last):
    ...
    bouncing_ball.pipeline.configuration.ConfigurationError: duplicate key 'n' in line 1
    """
    try:
        return yaml.load(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        line = f" in line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise ConfigurationError(f"not YAML{line}: {error.problem}") from None
    except yaml.YAMLError as error:
        # For example a character that is not allowed in YAML.
        raise ConfigurationError(f"not YAML: {' '.join(str(error).split())}") from None


def read_yaml(path: str | Path) -> Any:
    """The content of a YAML file.

    Raises
    ------
    ConfigurationError
        If the file does not exist, is not UTF-8, or :func:`parse_yaml` refuses its text. The
        message does not name the file.
    """
    try:
        return parse_yaml(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(str(error.strerror)) from None
    except UnicodeDecodeError:
        raise ConfigurationError("not UTF-8 text") from None


_OF_JOB = ("data", "part", "found")
SECTIONS = ("figures", "tables", "extensions", "studies")
"""Sections of the configuration in which each key is an artifact."""


def load(study: str) -> Callable[..., Any]:
    """The function with this dotted name in the package.

    Raises
    ------
    ConfigurationError
        If there is no such module or function.

    Examples
    --------
    >>> load("paper.contact.damping.damping_ratio")(1.0).item()
    0.0
    """
    module, _, function = study.rpartition(".")
    try:
        return getattr(import_module(f"bouncing_ball.{module}"), function)
    except (ModuleNotFoundError, AttributeError) as error:
        raise ConfigurationError(f"{study}: {error}") from None


def typed(study: Callable[..., Any]) -> Callable[..., Any]:
    """The study as a function of parameters in the form that the configuration has.

    It raises :class:`pydantic.ValidationError` if a parameter is not allowed.

    Examples
    --------
    >>> sweep = load("paper.exhibits.apparent_restitution.apparent_restitution")
    >>> case = {"restitution": 0.5, "amplitude": 1.5}
    >>> span = {"min": 10.0, "max": 1000.0, "samples": 3}
    >>> parameters = {"n": 1, "cases": [case], "frequency_ratio": span}
    >>> typed(sweep)(parameters, "displacement").frequency_ratio.values.tolist()
    [10.0, 100.0, 1000.0]
    """
    return validate_call(config=ConfigDict(arbitrary_types_allowed=True))(study)


def taken(study: str) -> dict[str, Any]:
    """The arguments that a study takes from the configuration, with their types.

    Raises
    ------
    ConfigurationError
        If there is no such study.

    Examples
    --------
    >>> list(taken("paper.exhibits.continuation_of_orbits.orbit_branches"))
    ['parameters', 'release', 'continuation']
    """
    signature = inspect.signature(load(study)).parameters.items()
    return {name: each.annotation for name, each in signature if name not in _OF_JOB}


def section(artifact: str, run: Mapping[str, Any]) -> str:
    """Name of the section of the configuration that holds the parameters of an artifact.

    Raises
    ------
    ConfigurationError
        If no section has this key.

    Examples
    --------
    >>> section("fig02", {"figures": {"fig02": {"n": 1}}})
    'figures'
    """
    for name in SECTIONS:
        if artifact in (run.get(name) or {}):
            return name
    raise ConfigurationError(
        f"{artifact} has no parameters: add a key {artifact} to one of {', '.join(SECTIONS)}"
    )


def arguments(study: str, artifact: str, run: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a study for an artifact, in the form that the configuration has.

    Raises
    ------
    ConfigurationError
        If there is no such study, or no section with this artifact.

    Examples
    --------
    >>> run = {"release": "force", "figures": {"fig05": {"n": 1}}}
    >>> arguments("paper.exhibits.apparent_restitution.apparent_restitution", "fig05", run)
    {'parameters': {'n': 1}, 'release': 'force'}
    """
    return {
        name: run[section(artifact, run)][artifact] if name == "parameters" else run[name]
        for name in taken(study)
    }


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
    >>> from bouncing_ball.datasets.parameters import Span
    >>> check(Span, {"min": 1.0, "max": 2.0, "sample": 3})
    Traceback (most recent call last):
    ...
    bouncing_ball.pipeline.configuration.ConfigurationError: unknown key sample = 3, did you mean \
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
