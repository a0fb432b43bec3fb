"""config/README.md from the schema: ``python -m bouncing_ball.configuration.documentation``.

The schema is the only place where a key is described; a test fails when the
page is not the one that the schema gives.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from bouncing_ball.configuration.check import resolved
from bouncing_ball.configuration.yaml_file import read_yaml

_HEAD = """# The configuration

Every key of `config.yaml`, with what is allowed. This page is made from
`schema.yaml` by `make config-docs`; change the schema, not the page.

Beside it stands `claims.yaml`, the ledger of the paper's claims. What the paper
printed is there and nowhere else; its schema, `claims.schema.yaml`, says how a
claim is written.

Numbers in powers of ten need a point and a sign, `1.0e+4`: YAML takes `1e4`
for a text. To try a change without editing `config.yaml`, write only the keys
that change into another file and name it last,
`snakemake --cores 2 fig12 --configfile mine.yaml`.

| key | allowed | meaning | default |
| --- | --- | --- | --- |
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
            yield from _rows(part, root, default.get(key), [*path, key])
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


def configuration_page(schema: Mapping[str, Any], config: Mapping[str, Any]) -> str:
    """The page as Markdown."""
    rows = _rows(schema, schema, config, [])
    return _HEAD + "".join("| `{}` | {} | {} | {} |\n".format(*row) for row in rows)


def main() -> None:
    """Write config/README.md in the working directory."""
    folder = Path("config")
    schema, config = (read_yaml(folder / name) for name in ("schema.yaml", "config.yaml"))
    page = configuration_page(schema, config)
    (folder / "README.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
