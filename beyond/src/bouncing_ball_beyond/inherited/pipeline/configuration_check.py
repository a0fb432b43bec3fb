"""The check of a configuration before a run.

The types of the parameters are classes beside the studies, so that the allowed values and the
reasons for them are defined there, and the type of the whole configuration names them in order.
Every mistake gives one line, and all mistakes are in one message.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from pydantic import BaseModel, ValidationError

from bouncing_ball_beyond.inherited.errors import printable
from bouncing_ball_beyond.inherited.pipeline.yaml_files import ConfigurationError, read_yaml


def check_configuration(
    files: Iterable[str], config: Mapping[str, Any], model: type[BaseModel]
) -> None:
    """Raise on mistakes in the files of a run, and in the configuration read from them.

    Raises
    ------
    ConfigurationError
        The message has a line for each mistake, which names the file or the key.
    """
    found: list[str] = []
    for where in files:
        try:
            # Snakemake has read the file already, but accepts duplicate keys without an error.
            read_yaml(where)
        except ConfigurationError as error:
            found += [f"{where}: {mistake}" for mistake in error.mistakes]
    try:
        check_parameters(model, config)
    except ConfigurationError as error:
        found += [f"configuration: {mistake}" for mistake in error.mistakes]
    if found:
        raise ConfigurationError(*found)


def check_parameters(model: type[BaseModel], config: Mapping[str, Any]) -> None:
    """Raise on the mistakes in a configuration of this type.

    Raises
    ------
    ConfigurationError
        The message has a line for each mistake: the key, the value and the allowed values.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.datasets.parameters import Span
    >>> check_parameters(Span, {"min": 1.0, "max": 2.0, "sample": 3})
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.pipeline.yaml_files.ConfigurationError: unknown key sample = \
3, did you mean \
samples? Allowed here: min, max, samples
    """
    try:
        # Some parameters are right under one setting of the run and wrong under another.
        model.model_validate(config, context=config)
    except ValidationError as error:
        found = _each_once(error.errors())
        raise ConfigurationError(*_sentences(model.model_json_schema(), found)) from None


def _each_once(errors: Iterable[Any]) -> list[Any]:
    """The errors of pydantic with unknown keys first, and one for each mistake.

    A mistyped key is reported as unknown and its right name as missing. Where a key is unknown, a
    missing key beside it is therefore left out if it may be the one that was meant.
    """
    ordered = sorted(errors, key=lambda each: each["type"] != "extra_forbidden")
    unknown = [each["loc"] for each in ordered if each["type"] == "extra_forbidden"]
    kept: dict[tuple[str | int, ...], Any] = {}
    for each in ordered:
        *above, key = each["loc"]
        meant = any(
            list(other[:-1]) == above and get_close_matches(str(other[-1]), [str(key)])
            for other in unknown
        )
        if each["type"] != "missing" or not meant:
            kept.setdefault(each["loc"], each)
    # A list without its wrong entries is too short; the entries are the mistake.
    inside = {loc[:k] for loc in kept for k in range(len(loc))}
    return [each for loc, each in kept.items() if each["type"] != "too_short" or loc not in inside]


def _sentences(root: Mapping[str, Any], errors: Iterable[Any]) -> Iterator[str]:
    """A sentence for each error; keys that are missing at one place share one."""
    missing: dict[tuple[str | int, ...], list[Any]] = {}
    for each in errors:
        if each["type"] == "missing":
            missing.setdefault(each["loc"][:-1], []).append(each)
        else:
            yield _sentence(root, each)
    for above, all_of_them in missing.items():
        if len(all_of_them) == 1:
            yield _sentence(root, all_of_them[0])
        else:
            names = ", ".join(str(each["loc"][-1]) for each in all_of_them)
            yield f"missing keys in {place(above) or 'the file'}: {names}"


def place(path: Sequence[str | int]) -> str:
    """A path of keys and indices in the configuration, as text.

    Examples
    --------
    >>> place(("paper", "fig08", "frequency_ratio", 0))
    'paper.fig08.frequency_ratio[0]'
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


def _schemas(root: Mapping[str, Any], path: Sequence[str | int]) -> list[dict[str, Any]]:
    """The schemas from that of the whole configuration to that of a key, which comes last."""
    found = [resolved(root, root)]
    for part in path:
        if isinstance(part, int):
            inner = found[-1].get("items", {})
        else:
            inner = found[-1].get("properties", {}).get(part, {})
        found.append(resolved(inner, root))
    return found


def _sentence(root: Mapping[str, Any], error: Any) -> str:
    """One sentence for an error: the place, the value, the allowed values, and the reason."""
    path = error["loc"]
    schemas = _schemas(root, path)
    schema = schemas[-1]
    kind = error["type"]
    name = place(path)
    description = " ".join(schema.get("description", "").split())
    given = f"{name} = {printable(repr(error['input']), 60)}"
    if kind == "extra_forbidden":
        known = list(schemas[-2]["properties"])
        close = get_close_matches(str(path[-1]), known, n=1)
        meant = f", did you mean {close[0]}?" if close else "."
        return f"unknown key {given}{meant} Allowed here: {', '.join(known)}"
    if kind == "missing":
        what = "section" if len(path) == 1 and "properties" in schema else "key"
        meaning = description or str(schema.get("title"))
        return f"missing {what} {name}" + ("" if meaning == name else f": {meaning}")
    if kind == "value_error":
        text = str(error["ctx"]["error"])
        return f"{given} {text}" if text.startswith("must") else f"{name}: {text}"
    text = error["msg"]
    if kind.startswith("model"):
        text = f"must be a mapping of the keys {', '.join(schema['properties'])}"
    for theirs, ours in _WORDS.items():
        text = text.replace(theirs, ours)
    return f"{given} {text}" + (f" ({description})" if description else "")
