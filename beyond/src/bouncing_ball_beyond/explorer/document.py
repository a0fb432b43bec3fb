"""The explorer's page: model, drawings and reference orbits in one file.

The scripts and the style are files beside this module. A content-security policy admits these texts
alone, by their checksums, so that the page can neither run another script nor load anything.
"""

import base64
import hashlib
import json
from collections.abc import Mapping
from importlib.resources import files
from typing import Any

import xarray as xr
from jinja2 import Environment, PackageLoader, StrictUndefined

BOUND = 1e-11
"""Difference from Python above which the badge is red: a hundred times the largest seen."""

SCRIPTS = "model simulation starts plot state orbit sound stage page".split()


def references(data: xr.Dataset) -> str:
    """The reference orbits and balls as JSON, one per line; a missing value is null."""
    found: dict[str, Any] = {"commit": str(data.attrs.get("provenance_commit", "unknown"))}
    for kind, dims in {"orbits": {"release", "sample"}, "balls": {"model", "motion"}}.items():
        table = data.drop_dims(set(data.dims) - dims).to_dataframe().reset_index()
        rows = table.astype(object).where(table.notna(), None)
        found[kind] = {"names": list(table), "rows": rows.values.tolist()}
    return json.dumps(found, allow_nan=False).replace("], [", "],\n[")


def _allowed(text: str) -> str:
    """The source expression by which the policy admits one inline text."""
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    return f"'sha256-{digest}'"


def to_html(data: xr.Dataset, quantities: Mapping[str, str]) -> str:
    """The page, including the reference values with which it checks its results.

    Parameters
    ----------
    data : xarray.Dataset
        Reference orbits (:mod:`bouncing_ball_beyond.exhibits.explorer_orbits`).
    quantities : mapping
        The names of the quantities in sentences.
    """
    *scripts, look, scenes = (
        files(__package__).joinpath(name).read_text(encoding="utf-8")
        for name in (*(f"{name}.js" for name in SCRIPTS), "page.css", "scenes.json")
    )
    script = "\n" + "\n".join(scripts)
    style = f"\n{look}"
    environment = Environment(
        loader=PackageLoader(str(__package__), "."), undefined=StrictUndefined, autoescape=False
    )
    policy = (
        f"default-src 'none'; script-src {_allowed(script)}; style-src {_allowed(style)}; "
        "base-uri 'none'; form-action 'none'"
    )
    return environment.get_template("page.html.j2").render(
        policy=policy,
        script=script,
        style=style,
        references=references(data),
        quantities=quantities,
        scenes=json.loads(scenes),
        bound=repr(BOUND),
    )
