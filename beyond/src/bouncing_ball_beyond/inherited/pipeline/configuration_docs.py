"""The page about the configuration and its JSON schema for editors, from the parameters' types."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import BaseModel

from bouncing_ball_beyond.inherited.pipeline.configuration_check import resolved

_HEAD = """# The configuration

The keys of `config.yaml` with the allowed values and the reasons. `make config-docs` makes this
page from the types beside the studies. Change those, and not the page. It also makes
`config/schema.json`, which is not in git: with it, an editor that knows YAML schemas completes the
keys of `config.yaml` and marks mistakes. Without it nothing is missing but this.

The section `paper` holds the parameters of the paper's figures, tables and claims; `release` and
`continuation` are settings of the whole run.
Everything is dimensionless except angles, which are in radians. Numbers in powers of ten need a
point and a sign, as in `1.0e+4`, because YAML reads `1e4` as text. To try a change without editing
`config.yaml`, write only the changed keys into another file and name it last:
`snakemake --cores 2 fig12 --configfile mine.yaml`.
"""
_TABLE = """
## {title}

| key | allowed | meaning | default |
| --- | --- | --- | --- |
"""
_LIMITS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}
_LONGEST_DEFAULT = 48


def configuration_schema(model: type[BaseModel]) -> str:
    """The JSON schema of a configuration, as text."""
    return json.dumps(model.model_json_schema(), indent=1, ensure_ascii=False) + "\n"


def _allowed(schema: Mapping[str, Any], root: Mapping[str, Any]) -> str:
    """The values that a schema allows, in words and limits."""
    if "enum" in schema:
        return ", ".join(f"`{value}`" for value in schema["enum"])
    if schema.get("type") == "array":
        return f"list of {_allowed(resolved(schema['items'], root), root)}"
    if schema.get("type") == "object":
        return "{" + ", ".join(schema["properties"]) + "}"
    word = "whole number" if schema["type"] == "integer" else schema["type"]
    limits = [f"{sign} {schema[key]:g}" for key, sign in _LIMITS.items() if key in schema]
    return ", ".join([word, *limits])


def _row(
    schema: Mapping[str, Any], root: Mapping[str, Any], default: Any, path: Sequence[str]
) -> str:
    """The row of one key: where it is, what is allowed, what it means, and its default."""
    items = resolved(schema.get("items", {}), root)
    # Of a docstring the first sentence, which has a line.
    meaning = schema.get("description", items.get("description", "")).partition("\n\n")[0]
    shown = json.dumps(default, ensure_ascii=False)
    shown = f"`{shown}`" if len(shown) <= _LONGEST_DEFAULT else "see `config.yaml`"
    return f"| `{'.'.join(path)}` | {_allowed(schema, root)} | {meaning} | {shown} |\n"


def _rows(
    schema: Mapping[str, Any], root: Mapping[str, Any], default: Any, path: Sequence[str]
) -> Iterator[str]:
    """The rows of a section, those of its keys in the order of the configuration."""
    schema = resolved(schema, root)
    if schema.get("type") != "object":
        yield _row(schema, root, default, path)
        return
    known = schema["properties"]
    # Keys that the configuration leaves out have the default of their type.
    values = default | {
        key: each.get("default") for key, each in known.items() if key not in default
    }
    for key, value in values.items():
        yield from _rows(known[key], root, value, [*path, key])


def configuration_page(model: type[BaseModel], config: Mapping[str, Any]) -> str:
    """The page in Markdown, a table for each section; the defaults are the values of ``config``."""
    root = model.model_json_schema()
    page = _HEAD
    for name, default in config.items():
        page += _TABLE.format(title=name)
        page += "".join(_rows(root["properties"][name], root, default, [name]))
    return page
