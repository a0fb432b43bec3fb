"""What several tests read: the configuration, the datasets of the reference, and the stages."""

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from types import ModuleType

import numpy as np
import pytest
import xarray as xr
import yaml
from tests.checkout import ROOT

from carbonelli2011 import article
from paper_replication import templates, texts
from paper_replication.configuration import entries
from paper_replication.datasets import Among, parameters, read

TOP = (ROOT / os.environ.get("CANDIDATE", "")).resolve()
"""The folder whose figures and texts the tests read: that of the reference, or that of the results
which `make accept` would make the reference."""
FIGURES = TOP / "figures"
CONFIG = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
ENTRIES = entries(CONFIG)
"""The registered figures, tables and datasets by name."""


@cache
def reference() -> dict[str, xr.Dataset]:
    """All datasets by name, which are to be copied before they are changed.

    A test that reads them is skipped if they are not those of today's configuration.
    """
    # A new figure of a dataset that exists changes no number.
    needed = {name for name, entry in ENTRIES.items() if "data" not in entry}
    if new := sorted(needed - {path.stem for path in FIGURES.iterdir()}):
        why = f"new, and not accepted yet: {', '.join(new)}. Run make accept, then make test"
        pytest.skip(why, allow_module_level=True)
    datasets = {path.stem: read(path) for path in FIGURES.glob("*.nc")}
    if differences := article.unlike_the_paper(datasets):
        lines = "; ".join(differences)
        why = f"not of the parameters in paper.py: {lines}. Change one of them, run make accept"
        pytest.skip(why, allow_module_level=True)
    return datasets


@contextmanager
def without_gaps() -> Iterator[None]:
    """Texts of the article in which a number that is missing is a failure, instead of a dash."""
    fixed = texts.fixed

    def finite(value, digits, shift=0):
        assert np.isfinite(value)
        return fixed(value, digits, shift)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(texts, "fixed", finite)
        filters = templates.environment(article.TEMPLATES, True).filters
        patch.setitem(filters, "fixed", finite)
        yield


def stage(name: str) -> ModuleType:
    """The module of a stage."""
    return import_module(f"carbonelli2011.stages.{name}")


@cache
def table_with_another_row() -> xr.Dataset:
    """Table 1 computed with a row that the paper does not print, between those that it prints."""
    given = CONFIG["continuation"]["table1"] | {"frequency_ratio": [1e4, 50.0, 10.0, 2.0]}
    table = stage("continuation").table1(given, CONFIG["release"])
    return table.assign_attrs(
        title=ENTRIES["table1"]["title"],
        parameters=json.dumps(given | {"release": CONFIG["release"]}),
    )


def with_parameters(data: xr.Dataset, **others) -> xr.Dataset:
    """A dataset as if it were computed with other parameters."""
    return data.assign_attrs(parameters=json.dumps(parameters(data) | others))


def with_more(data: xr.Dataset, needed: Mapping, place: int) -> xr.Dataset:
    """A dataset with a further curve or row at a place, where a list may have more than is needed.

    Its numbers are wrong, and in the parameters it is the first.
    """
    given = parameters(data)
    for key, value in needed.items():
        if isinstance(value, Among):
            along = value.dimension
            first = data.isel({along: [0]})
            wrong = {
                name: (
                    variable.dims,
                    np.array(["more"]) if variable.dtype.kind in "OU" else 7 * variable.values,
                )
                for name, variable in first.variables.items()
                if along in variable.dims and (name in first.coords or variable.dtype.kind == "f")
            }
            more = first.assign(wrong).set_coords(first.coords)
            parts = [data.isel({along: slice(place)}), more, data.isel({along: slice(place, None)})]
            data = xr.concat(parts, along, data_vars="minimal", coords="minimal", compat="override")
            given[key].insert(0, "more")
    return data.assign_attrs(parameters=json.dumps(given))
