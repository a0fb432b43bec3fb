"""Shared by the tests: accepted datasets, and the variables that the datasets have."""

from pathlib import Path

import pytest
from declared_variables import variables_of

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.datasets.files import read_dataset

HOUSE = Path(__file__).resolve().parents[1]
pytest_plugins = ["shared_fixtures", "taylor_ball", "article_texts"]


@pytest.fixture(scope="session")
def recorded():
    """The accepted datasets by name."""
    return {path.stem: read_dataset(path) for path in sorted((HOUSE / "figures").glob("*.nc"))}


@pytest.fixture(scope="session")
def declared():
    """The variables of all datasets: those that studies share, and those of each study."""
    return variables_of(bouncing_ball_beyond)
