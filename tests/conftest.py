"""Shared by the root's tests: the accepted record, what variables are declared, settings.

What the tests of all houses share is in :mod:`shared_fixtures`.
"""

import importlib
import os
from pathlib import Path

import numpy as np
import pytest

import bouncing_ball
from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.datasets.variables import SHARED
from bouncing_ball.paper.exhibits.continuation_of_orbits import Continuation
from bouncing_ball.paper.exhibits.orbit_parameters import OrbitsOfContacts
from bouncing_ball.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[1]
pytest_plugins = ["shared_fixtures", "article_texts"]


def pytest_collection_modifyitems(items):
    """With several workers the long tests first, so that none runs alone at the end."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        items.sort(key=lambda item: "workflow" not in item.path.parts)


@pytest.fixture(scope="session")
def recorded():
    """The accepted datasets by name."""
    return {path.stem: read_dataset(path) for path in sorted((ROOT / "figures").glob("*.nc"))}


@pytest.fixture(scope="session")
def declared():
    """The variables of all datasets: those that stages share, and those of each stage."""
    found = dict(SHARED)
    for path in sorted(Path(bouncing_ball.__file__).parent.rglob("*.py")):
        if "\nVARIABLES = {" in path.read_text(encoding="utf-8"):
            name = ".".join(path.relative_to(ROOT / "src").with_suffix("").parts)
            own = importlib.import_module(name).VARIABLES
            # A name has one meaning, whatever the dataset.
            assert not found.keys() & own.keys(), (name, found.keys() & own.keys())
            found |= own
    return found


@pytest.fixture(scope="session")
def described(declared):
    """Asserts that every variable and dimension of a dataset has a name and a description."""

    def check(dataset):
        for name in dataset.variables:
            attributes = dataset[name].attrs
            assert attributes.get("long_name"), name
            if dataset[name].dtype.kind in "fiu":
                assert attributes.get("units") in ("1", "rad"), name
            else:
                assert dataset[name].dtype.kind in "bU", name
        assert set(dataset.dims) <= set(declared)
        return dataset

    return check


@pytest.fixture(scope="session")
def continuation_settings():
    """The ``continuation`` section of the configuration."""
    return Continuation(**read_yaml(ROOT / "config" / "config.yaml")["continuation"])


@pytest.fixture(scope="module")
def searched_once():
    """Checks of the configuration search the orbits of the same parameters once."""
    search = OrbitsOfContacts.exists
    known = {}

    def exists(self, ratios):
        question = (*self._replace(amplitudes=tuple(self.amplitudes)), *np.asarray(ratios))
        if question not in known:
            known[question] = search(self, ratios)
        return known[question]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(OrbitsOfContacts, "exists", exists)
        yield
