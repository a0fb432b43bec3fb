"""Shared by the tests of beyond: accepted datasets, and the variables that its datasets have."""

from pathlib import Path

import pytest
from declared_variables import variables_of

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.periodic.branches import VARIABLES

HOUSE = Path(__file__).resolve().parents[1]
# Of the root: references, the command line, the browser. Here: a reference integration.
pytest_plugins = ["shared_fixtures", "taylor_ball", "beyond_texts"]


@pytest.fixture(scope="session")
def recorded():
    """The accepted datasets by name: those of beyond, and those of the replication."""
    folders = (HOUSE / "figures", HOUSE.parent / "figures")
    paths = [path for folder in folders for path in sorted(folder.glob("*.nc"))]
    return {path.stem: read_dataset(path) for path in paths}


@pytest.fixture(scope="session")
def declared():
    """The variables of all datasets: those of stages, and those of the root's branches."""
    return variables_of(bouncing_ball_beyond) | VARIABLES
