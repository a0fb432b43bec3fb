"""Shared by the tests of beyond: accepted datasets, and the variables that its datasets have."""

import importlib
import os
from pathlib import Path

import pytest

import bouncing_ball_beyond
from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.datasets.variables import SHARED

HOUSE = Path(__file__).resolve().parents[1]
PACKAGE = Path(bouncing_ball_beyond.__file__).parent
# Of the root: references, the command line, the browser. Here: a reference integration.
pytest_plugins = ["shared_fixtures", "taylor_ball", "beyond_texts"]


def pytest_collection_modifyitems(items):
    """With several workers the long tests first, so that none runs alone at the end."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        items.sort(key=lambda item: "explorer" not in item.path.parts)


@pytest.fixture(scope="session")
def recorded():
    """The accepted datasets by name: those of beyond, and those of the replication."""
    folders = (HOUSE / "figures", HOUSE.parent / "figures")
    paths = [path for folder in folders for path in sorted(folder.glob("*.nc"))]
    return {path.stem: read_dataset(path) for path in paths}


@pytest.fixture(scope="session")
def declared():
    """The variables of all datasets: those that stages share, and those of each stage."""
    found = dict(SHARED)
    for path in sorted(PACKAGE.rglob("*.py")):
        if "\nVARIABLES = {" in path.read_text(encoding="utf-8"):
            name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
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
