"""The explorer's page: models, drawings and reference orbits in one file.

Its scripts, style and scenes are in the folder `explorer`. A content security policy admits their
texts alone, by their checksums, so that the page can neither run another script nor load anything.
"""

import base64
import hashlib
import json
from pathlib import Path
from typing import Any

import jinja2
import xarray as xr

FOLDER = Path(__file__).parents[1] / "explorer"

SCRIPTS = "model simulation starts plot state orbit stage question page".split()
"""The scripts in the order in which the page has them."""

FILES = sorted(FOLDER.iterdir())
"""All files that the page is made of."""

BOUND = 1e-11
"""Largest relative difference of the page's numbers from those of the dataset: a hundred times the
largest that was seen."""

QUANTITIES = {
    "max_height": "maximum height",
    "bounce_velocity": "bouncing-off velocity",
    "phase": "phase of the impact, share of a period",
    "apparent_restitution": "apparent restitution",
    "saddle_node": "saddle-node",
    "period_doubling": "period doubling",
    "permanent_contact": "threshold of permanent contact",
}
"""The quantities that the page compares, in words."""


WAYS = {
    "README": "../../../README.md",
    "Article": "../article.md",
    "Course": "../docs/first-hour.md",
    "Code": "../README.md",
}
"""Where the page leads, from its folder in the repository."""


def references(data: xr.Dataset) -> str:
    """The reference orbits and balls as JSON, one per line; a missing value is null."""
    tables: dict[str, Any] = {}
    for kind, dimensions in {
        "orbits": {"release", "sample"},
        "balls": {"model", "motion"},
    }.items():
        table = data.drop_dims(set(data.dims) - dimensions).to_dataframe().reset_index()
        rows = table.astype(object).where(table.notna(), None)
        tables[kind] = {"names": list(table), "rows": rows.values.tolist()}
    return json.dumps(tables, allow_nan=False).replace("], [", "],\n[")


def admitted(text: str) -> str:
    """The expression by which a content security policy admits one text."""
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    return f"'sha256-{digest}'"


def page(data: xr.Dataset) -> str:
    """The page, with the dataset against which it checks what it computes."""
    texts = {path.name: path.read_text(encoding="utf-8") for path in FILES}
    script = "\n" + "\n".join(texts[f"{name}.js"] for name in SCRIPTS)
    style = "\n" + texts["page.css"]
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)
    policy = (
        f"default-src 'none'; script-src {admitted(script)}; style-src {admitted(style)}; "
        "base-uri 'none'; form-action 'none'"
    )
    return environment.from_string(texts["page.html.j2"]).render(
        policy=policy,
        script=script,
        style=style,
        references=references(data),
        quantities=QUANTITIES,
        scenes=json.loads(texts["scenes.json"]),
        ways=WAYS,
        bound=repr(BOUND),
    )
