"""Check of the configuration, with one line per mistake.

The schema says what each key may be; :func:`check_configuration` adds what a
schema cannot say: that numbers are finite, ranges are not empty, the printed
table has the shape of the computed one, and that the restitution orbits which
a figure needs exist (Eq. 7).
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from jsonschema import Draft202012Validator, ValidationError, validators

from bouncing_ball.errors import ModelError

# JSON takes 801.0 for an integer; a number of samples is written 801.
_Validator = validators.extend(
    Draft202012Validator,
    type_checker=Draft202012Validator.TYPE_CHECKER.redefine(
        "integer", lambda _, value: type(value) is int
    ),
)


class ConfigurationError(ModelError):
    """A wrong key, type or value in the configuration, in one line."""


def _dotted(path) -> str:
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else str(part)
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
            words = f"must be {_KINDS.get(limit, limit)}"
            if _looks_like_number(error.instance):
                notes.insert(0, "powers of ten are written 1.0e+4, with point and sign")
        case "minimum":
            words = f"must be at least {limit:g}"
        case "maximum":
            words = f"must be at most {limit:g}"
        case "exclusiveMinimum":
            words = f"must be greater than {limit:g}"
        case "exclusiveMaximum":
            words = f"must be less than {limit:g}"
        case "enum":
            words = "must be one of " + ", ".join(map(str, limit))
        case "minItems":
            words = f"must have at least {limit} item{'s' if limit > 1 else ''}"
        case "maxItems":
            words = f"must have at most {limit} items"
        case "uniqueItems":
            words = "must not repeat an item"
        case _:
            words = error.message
    return f"{words} ({'; '.join(notes)})" if notes else words


def _message(error: ValidationError) -> str:
    where = _dotted(error.absolute_path)
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        unknown = next(key for key in error.instance if key not in known)
        key = f"{where}.{unknown}" if where else str(unknown)
        value = _shown(error.instance[unknown])
        return f"unknown key {key} = {value}; allowed here: {', '.join(known)}"
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in error.instance)
        return f"missing key {where + '.' if where else ''}{missing}"
    return f"{where or 'the whole file'} = {_shown(error.instance)} {_allowed(error)}"


def _numbers(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, float]]:
    if isinstance(value, Mapping):
        for key, part in value.items():
            yield from _numbers(part, (*path, key))
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from _numbers(part, (*path, index))
    elif isinstance(value, float):
        yield path, value


def _spans(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, Mapping]]:
    if isinstance(value, Mapping):
        if {"min", "max"} <= set(value):
            yield path, value
        for key, part in value.items():
            yield from _spans(part, (*path, key))


def _check_consistency(config: Mapping[str, Any]) -> None:
    steps = config["continuation"]
    if not steps["smallest_step"] <= steps["initial_step"] <= steps["largest_step"]:
        raise ConfigurationError(
            f"continuation.initial_step = {steps['initial_step']} must lie between "
            f"smallest_step = {steps['smallest_step']} and largest_step = {steps['largest_step']}"
        )
    for path, span in _spans(config):
        if span["min"] >= span["max"]:
            raise ConfigurationError(
                f"{_dotted(path)}.min = {span['min']} must be less than max = {span['max']}"
            )
    table = config["tables"]["table1"]
    shape = (len(table["frequency_ratio"]), len(table["n"]))
    printed = table["printed"]
    if len(printed) != shape[0] or any(len(row) != shape[1] for row in printed):
        raise ConfigurationError(
            f"tables.table1.printed = {_shown(printed)} must have {shape[0]} rows (one per "
            f"frequency_ratio) of {shape[1]} ranges (one per n)"
        )


def _needs(config: Mapping[str, Any]) -> Iterator[tuple[str, float, list[int], float]]:
    """Key and value of every Λ at which, or up to which, an orbit is needed."""
    sections = {section: config[section] for section in ("figures", "tables")}
    for name, figure in config["extensions"].items():
        sections[f"extensions.{name}"] = {key: figure[key] for key in ("thresholds",)}
    for section, parts in sections.items():
        for name, figure in parts.items():
            for index, case in enumerate(figure.get("cases", [])):
                key = f"{section}.{name}.cases[{index}].amplitude"
                yield key, case["amplitude"], [figure["n"]], case["restitution"]
            for label in ("amplitude", "amplitude_max"):
                values = figure.get(label, [])
                listed = isinstance(values, list)
                for index, value in enumerate(values if listed else [values]):
                    key = f"{section}.{name}.{label}" + (f"[{index}]" if listed else "")
                    n = figure["n"] if isinstance(figure["n"], list) else [figure["n"]]
                    yield key, value, n, figure["restitution"]


def _check_existence(config: Mapping[str, Any]) -> None:
    # Imported here: numpy is not needed to refuse a mistyped key.
    from bouncing_ball.orbits.restitution import period_doubling, saddle_node

    for key, value, families, r in _needs(config):
        # The branch of the highest family starts last.
        n = max(families)
        if key.startswith("tables.table1"):
            lowest = 1.1 * float(period_doubling(n, r))
            what = "period doubling, with a tenth to spare,"
        else:
            lowest, what = float(saddle_node(n, r)), "saddle-node"
        if value < lowest:
            raise ConfigurationError(
                f"{key} = {value} must be at least {lowest:.6g}, the {what} of the "
                f"{n}-T restitution orbit at r = {r} (Eqs. 7-8)"
            )


def check_schema(content: Any, schema: Mapping[str, Any]) -> None:
    """Raise on the first thing in a parsed file that its schema does not allow.

    Raises
    ------
    ConfigurationError
        One line that names the key, the value and what is allowed.
    """
    for path, value in _numbers(content):
        if not math.isfinite(value):
            raise ConfigurationError(f"{_dotted(path)} = {value} must be a finite number")
    errors = sorted(
        _Validator(schema).iter_errors(content),
        key=lambda error: [str(part) for part in error.absolute_path],
    )
    if errors:
        raise ConfigurationError(_message(errors[0]))


def check_configuration(config: Mapping[str, Any], schema: Mapping[str, Any]) -> None:
    """Raise on the first mistake in a configuration.

    Raises
    ------
    ConfigurationError
        One line that names the key, the value and what is allowed.

    Examples
    --------
    >>> schema = {"properties": {"n": {"type": "integer", "minimum": 1}}}
    >>> check_configuration({"n": 0}, schema)
    Traceback (most recent call last):
    ...
    bouncing_ball.pipeline.configuration.ConfigurationError: n = 0 must be at least 1
    """
    check_schema(config, schema)
    _check_consistency(config)
    _check_existence(config)
