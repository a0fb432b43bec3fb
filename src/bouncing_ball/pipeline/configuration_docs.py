"""The page about the configuration and its JSON schema for editors, from the parameters' types."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from bouncing_ball.pipeline.configuration import resolved

_HEAD = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")
_TABLE = "\n## {title}\n\n| key | allowed | meaning | default |\n| --- | --- | --- | --- |\n"


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
        known = schema["properties"]
        values = default | {k: default.get(k, x.get("default")) for k, x in known.items()}
        for key, value in values.items():
            yield from _rows(known[key], root, value, [*path, key])
        return
    items = resolved(schema.get("items", {}), root)
    meaning = schema.get("description", items.get("description", ""))
    shown = json.dumps(default, ensure_ascii=False)
    shown = f"`{shown}`" if len(shown) <= 48 else "see `config.yaml`"
    yield f"| `{'.'.join(path)}` | {_allowed(schema, root)} | {meaning} | {shown} |\n"


def configuration_page(model: type[BaseModel], config: Mapping[str, Any]) -> str:
    """The page in Markdown, a table for each section; the defaults are the values of ``config``."""
    root, page = model.model_json_schema(), _HEAD
    for name, default in config.items():
        rows = "".join(_rows(root["properties"][name], root, default, [name]))
        page += _TABLE.format(title=name) + rows
    return page
