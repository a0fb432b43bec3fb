"""The explorer's page: model, drawings and reference orbits in one file.

The scripts and the style are files beside this module. A content-security policy admits exactly
these texts, by their checksums, so that the page can run no other script and load nothing from
anywhere.
"""

import base64
import hashlib
import json
from importlib.resources import files

import numpy as np
import xarray as xr
from jinja2 import Environment, PackageLoader, StrictUndefined

from bouncing_ball.datasets.selection import each

BOUND = 1e-11
"""Difference from Python above which the badge is red: a hundred times the largest seen."""
STATE = ("release", "restitution", "frequency_ratio", "n", "amplitude")
"""Parameters of a reference orbit, in the order of its ``state``."""


def references(data: xr.Dataset) -> str:
    """The reference orbits as JSON, one per line; a quantity that does not exist is null."""
    names = [str(name) for name in data.data_vars if name not in STATE]
    rows = []
    for one in each(data, "release", "sample"):
        values = [float(one[name]) for name in names]
        row = {
            "state": [one[name].item() for name in STATE],
            "values": [value if np.isfinite(value) else None for value in values],
        }
        rows.append(json.dumps(row, allow_nan=False))
    commit = str(data.attrs.get("provenance_commit", "unknown"))
    head = f'{{"commit": {json.dumps(commit)}, "names": {json.dumps(names)}, "orbits": ['
    return "\n".join([head, ",\n".join(rows), "]}"])


def _allowed(text: str) -> str:
    """The source expression of the policy that admits one inline text."""
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    return f"'sha256-{digest}'"


def to_html(data: xr.Dataset, engines: str) -> str:
    """The page with what it checks itself against.

    Parameters
    ----------
    data : xarray.Dataset
        Reference orbits (:mod:`bouncing_ball.studies.reference_orbits`).
    engines : str
        The physics engines with reference settings, as JSON
        (:mod:`bouncing_ball.engines.reference`).
    """
    *scripts, look = (
        files(__package__).joinpath(name).read_text(encoding="utf-8")
        for name in ("model.js", "engines.js", "page.js", "page.css")
    )
    script, style = "\n" + "\n".join(scripts), f"\n{look}"
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
        engines=engines,
        names=list(json.loads(engines)["engines"]),
        bound=repr(BOUND),
    )
