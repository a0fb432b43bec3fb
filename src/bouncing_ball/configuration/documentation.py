"""The page about the configuration and its JSON schema for editors, from the parameters' types."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from bouncing_ball.configuration.check import resolved

_HEAD = """# The configuration

The keys of `config.yaml`, with what is allowed and why. This page and `schema.json`, which
editors read, are made from the types that stand beside the studies, by `make config-docs`;
change those, not the page.

Everything is dimensionless but for angles, in radians. Numbers in powers of ten need a point and
a sign, `1.0e+4`: YAML takes `1e4` for a text. To try a change without editing `config.yaml`,
write only the keys that change into another file and name it last,
`snakemake --cores 2 fig12 --configfile mine.yaml`.
"""
_TABLE = """
## {title}

| key | allowed | meaning | default |
| --- | --- | --- | --- |
"""


def configuration_schema(model: type[BaseModel]) -> str:
    """The JSON schema of a configuration, as text."""
    return json.dumps(model.model_json_schema(), indent=1, ensure_ascii=False) + "\n"


def _allowed(schema: Mapping[str, Any], root: Mapping[str, Any]) -> str:
    if "enum" in schema:
        return ", ".join(f"`{value}`" for value in schema["enum"])
    if schema.get("type") == "array":
        return f"list of {_allowed(resolved(schema['items'], root), root)}"
    if schema.get("type") == "object":
        return "{" + ", ".join(schema["properties"]) + "}"
    words = {"integer": "whole number"}.get(schema["type"], schema["type"])
    signs = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}
    limits = [f"{sign} {schema[key]:g}" for key, sign in signs.items() if key in schema]
    return ", ".join([words, *limits])


def _rows(schema, root, default, path) -> Iterator[str]:
    schema = resolved(schema, root)
    if schema.get("type") == "object":
        for key, part in default.items():
            yield from _rows(schema["properties"][key], root, part, [*path, key])
        return
    items = resolved(schema.get("items", {}), root)
    meaning = schema.get("description", items.get("description", ""))
    shown = json.dumps(default, ensure_ascii=False)
    shown = f"`{shown}`" if len(shown) <= 48 else "see `config.yaml`"
    yield f"| `{'.'.join(path)}` | {_allowed(schema, root)} | {meaning} | {shown} |\n"


def configuration_page(model: type[BaseModel], config: Mapping[str, Any]) -> str:
    """The page in Markdown: a table for each section, with the values of ``config`` as defaults."""
    root, page = model.model_json_schema(), _HEAD
    for name, default in config.items():
        rows = "".join(_rows(root["properties"][name], root, default, [name]))
        page += _TABLE.format(title=name) + rows
    return page
