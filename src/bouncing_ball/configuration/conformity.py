"""Whether a file's content is what a JSON schema allows, with one line per mistake.

The ledger and the tolerances are checked with this too; so it knows no stages.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from jsonschema import Draft202012Validator, ValidationError, validators

from bouncing_ball.configuration.yaml_file import ConfigurationError

# JSON takes 801.0 for an integer; a number of samples is written 801.
_Validator = validators.extend(
    Draft202012Validator,
    type_checker=Draft202012Validator.TYPE_CHECKER.redefine(
        "integer", lambda _, value: type(value) is int
    ),
)


def dotted(path, root: Any = None) -> str:
    """A path in words; an entry of a list that has an ``id`` is called by it."""
    text = ""
    value: Any = root
    for part in path:
        value = value[part] if root is not None else {}
        if isinstance(part, int):
            name = value.get("id") if isinstance(value, Mapping) else None
            text += f"[{_shown(name)}]" if isinstance(name, str) else f"[{part}]"
        else:
            text += f".{part}" if text else str(part)
    return text


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


_KINDS = {
    "object": "a mapping of keys",
    "array": "a list",
    "number": "a number",
    "integer": "a whole number",
    "string": "a text",
}
_LIMITS = {
    "minimum": "must be at least {:g}",
    "maximum": "must be at most {:g}",
    "exclusiveMinimum": "must be greater than {:g}",
    "exclusiveMaximum": "must be less than {:g}",
    "maxItems": "must have at most {} items",
    "uniqueItems": "must not repeat an item",
    "minLength": "must not be empty",
    "maxLength": "must have at most {} characters",
}


def _looks_like_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return isinstance(value, str)


def _allowed(error: ValidationError) -> str:
    """What is allowed where the schema was violated, in words."""
    limit = error.validator_value
    notes = [error.schema["description"]] if "description" in error.schema else []
    match error.validator:
        case "type":
            kinds = limit if isinstance(limit, list) else [limit]
            words = "must be " + " or ".join(_KINDS.get(str(kind), str(kind)) for kind in kinds)
            if _looks_like_number(error.instance):
                notes.insert(0, "powers of ten are written 1.0e+4, with point and sign")
        case "enum":
            words = "must be one of " + ", ".join(map(str, limit))
        case "minItems":
            words = f"must have at least {limit} item{'s' if limit > 1 else ''}"
        case "minProperties":
            words = f"must have at least {limit} key{'s' if limit > 1 else ''}"
        case "pattern" | "oneOf" if notes:
            words = f"must be {notes.pop()}"
        case rule:
            words = _LIMITS[rule].format(limit) if rule in _LIMITS else error.message
    return f"{words} ({'; '.join(notes)})" if notes else words


def resolved(schema: Mapping[str, Any], root: Mapping[str, Any]) -> dict[str, Any]:
    """A schema with what it refers to by ``$ref`` filled in; its own entries win.

    Examples
    --------
    >>> root = {"$defs": {"ratio": {"type": "number", "minimum": 0}}}
    >>> resolved({"$ref": "#/$defs/ratio", "minimum": 1}, root)
    {'type': 'number', 'minimum': 1}
    """
    own = {key: value for key, value in schema.items() if key != "$ref"}
    if "$ref" not in schema:
        return own
    target: Any = root
    for part in schema["$ref"].removeprefix("#/").split("/"):
        target = target[part]
    return resolved(target, root) | own


def _known_keys(schema: Mapping[str, Any], root: Mapping[str, Any]) -> list[str]:
    """The keys that a schema allows, those of the schema it extends first."""
    extended = {"$ref": schema["$ref"]} if "$ref" in schema else {}
    base = resolved(extended, root).get("properties", {})
    return list(dict.fromkeys([*base, *schema.get("properties", {})]))


def _chosen(error: ValidationError) -> ValidationError | None:
    """The error within the alternative that was meant, if one key shows which."""
    met = [
        index
        for index, option in enumerate(error.validator_value)
        if "required" in option and all(key in error.instance for key in option["required"])
    ]
    within = [part for part in error.context or [] if part.relative_schema_path[0] in met]
    return within[0] if len(met) == 1 and within else None


def _message(error: ValidationError, mapping: Any, root: Mapping[str, Any]) -> str:
    where = dotted(error.absolute_path, mapping)
    key, where = f"{where}." if where else "", where or "the whole file"
    if error.validator in ("additionalProperties", "unevaluatedProperties"):
        known = _known_keys(error.schema, root)
        unknown = next((name for name in error.instance if name not in known), None)
        if unknown is not None:
            value = _shown(error.instance[unknown])
            return f"unknown key {key}{unknown} = {value}; allowed here: {', '.join(known)}"
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in error.instance)
        return f"missing key {key}{missing}"
    if error.validator == "oneOf" and isinstance(error.instance, Mapping):
        chosen = _chosen(error)
        if chosen is not None:
            return _message(chosen, mapping, root)
        if all("required" in option for option in error.validator_value):
            names = [name for option in error.validator_value for name in option["required"]]
            found = " and ".join(name for name in names if name in error.instance) or "none"
            return f"{where} must have one of {', '.join(names)}; it has {found}"
    return f"{where} = {_shown(error.instance)} {_allowed(error)}"


def _numbers(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, float]]:
    if isinstance(value, Mapping):
        for key, part in value.items():
            yield from _numbers(part, (*path, key))
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from _numbers(part, (*path, index))
    elif isinstance(value, float):
        yield path, value


def check_schema(mapping: Mapping[str, Any], schema: Mapping[str, Any]) -> None:
    """Raise on the first violation of a schema, or number that is not finite.

    Raises
    ------
    ConfigurationError
        One line that names the key, the value and what is allowed.

    Examples
    --------
    >>> check_schema({"n": 0}, {"properties": {"n": {"type": "integer", "minimum": 1}}})
    Traceback (most recent call last):
    ...
    bouncing_ball.configuration.yaml_file.ConfigurationError: n = 0 must be at least 1
    """
    for path, value in _numbers(mapping):
        if not math.isfinite(value):
            raise ConfigurationError(f"{dotted(path, mapping)} = {value} must be a finite number")
    errors = sorted(
        _Validator(schema).iter_errors(mapping),
        key=lambda error: [str(part) for part in error.absolute_path],
    )
    if errors:
        raise ConfigurationError(_message(errors[0], mapping, schema))
