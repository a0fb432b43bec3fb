"""config/README.md from kinds and stages: ``python -m bouncing_ball.configuration.documentation``.

``config/schema.yaml`` is the only place where a key is described; a test fails
when the page is another one.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from bouncing_ball.configuration.conformity import resolved
from bouncing_ball.configuration.schema import configuration_schema
from bouncing_ball.configuration.stages import STAGES
from bouncing_ball.configuration.yaml_file import read_yaml

_HEAD = """# The configuration

The keys of `config.yaml`, with what is allowed. This page is made from
`schema.yaml` and the entries of the stages by `make config-docs`; change those,
not the page.

Numbers in powers of ten need a point and a sign, `1.0e+4`: YAML takes `1e4`
for a text. To try a change without editing `config.yaml`, write only the keys
that change into another file and name it last,
`snakemake --cores 2 fig12 --configfile mine.yaml`.
"""
_RUN = """
## The whole run, and the audit

| key | allowed | meaning | default |
| --- | --- | --- | --- |
"""
_ARTIFACTS = """
## Figures, tables and extensions

Each takes some of these keys, as `config.yaml` shows; where a key has several
rows, the entry of the stage says which one holds.

| key | allowed | meaning |
| --- | --- | --- |
"""


def _allowed(schema: Mapping[str, Any], root: Mapping[str, Any]) -> str:
    if "enum" in schema:
        return ", ".join(f"`{value}`" for value in schema["enum"])
    if schema["type"] == "array":
        return f"list of {_allowed(resolved(schema['items'], root), root)}"
    if schema["type"] == "object":
        return "{" + ", ".join(schema["properties"]) + "}"
    words = {"integer": "whole number", "string": "text"}.get(schema["type"], schema["type"])
    signs = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}
    limits = [f"{sign} {schema[key]:g}" for key, sign in signs.items() if key in schema]
    return ", ".join([words, *limits])


def _rows(schema, root, default, path) -> Iterator[tuple[str, str, str, str]]:
    schema = resolved(schema, root)
    if schema.get("type") == "object":
        for key, part in schema["properties"].items():
            yield from _rows(part, root, (default or {}).get(key), [*path, key])
        return
    if default is None:
        yield ".".join(path), _allowed(schema, root), schema["description"], "not set"
        return
    shown = yaml.safe_dump(default, default_flow_style=True, width=10_000)
    shown = shown.removesuffix("\n").removesuffix("\n...")
    if len(shown) > 48:
        shown = "see `config.yaml`"
    else:
        shown = f"`{shown}`"
    yield ".".join(path), _allowed(schema, root), schema.get("description", ""), shown


def configuration_page(kinds: Mapping[str, Any], config: Mapping[str, Any]) -> str:
    """The page as Markdown, from the content of ``schema.yaml`` and ``config.yaml``."""
    schema = configuration_schema(kinds)
    run = {"properties": {name: schema["properties"][name] for name in kinds["properties"]}}
    rows = _rows({"type": "object", **run}, schema, config, [])
    page = _HEAD + _RUN + "".join("| `{}` | {} | {} | {} |\n".format(*row) for row in rows)
    pairs = dict.fromkeys(pair for stage in STAGES.values() for pair in stage.takes.items())
    lines = {
        "| `{}` | {} | {} |\n".format(*row): None
        for key, kind in sorted(pairs)
        for row in _rows({"$ref": f"#/$defs/{kind}"}, schema, {}, [key])
    }
    return page + _ARTIFACTS + "".join(lines)


def main() -> None:
    """Write config/README.md in the working directory."""
    folder = Path("config")
    schema, config = (read_yaml(folder / name) for name in ("schema.yaml", "config.yaml"))
    page = configuration_page(schema, config)
    (folder / "README.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
