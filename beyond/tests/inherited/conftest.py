"""Shared by the root's tests: the accepted record, what variables are declared, settings.

What the tests of all houses share is in :mod:`shared_fixtures`.
"""

from pathlib import Path

import numpy as np
import pytest
from bouncing_ball_beyond.inherited.paper.exhibits.continuation_of_orbits import Continuation
from bouncing_ball_beyond.inherited.paper.exhibits.orbit_parameters import OrbitsOfContacts
from declared_variables import variables_of

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[1]
pytest_plugins = ["shared_fixtures", "article_texts"]


@pytest.fixture(scope="session")
def recorded():
    """The accepted datasets by name."""
    return {path.stem: read_dataset(path) for path in sorted((ROOT / "figures").glob("*.nc"))}


@pytest.fixture(scope="session")
def declared():
    """The variables of all datasets: those that stages share, and those of each stage."""
    return variables_of(bouncing_ball_beyond.inherited)


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
