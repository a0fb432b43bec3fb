"""What bounce one gets: engines whose restitution is a number that the user sets.

`make test-engines` writes the datasets bounces.nc and bounce_settings.nc in docs/data. An engine
that is not installed is skipped by its name, and then its dataset is not written.
"""

import math
from importlib.metadata import version

import numpy as np
import pytest
import xarray as xr
from bounce_runs import BOUNCE, SETTINGS, G, rebounds
from installed_engines import LAST_SEEN, engine_of, only_if_installed, package
from the_docs import DATA, MEASURED

from bouncing_ball_beyond.inherited.datasets.files import read_dataset, write_dataset
from bouncing_ball_beyond.inherited.datasets.variables import describe
from bouncing_ball_contacts.documents.bounces import (
    ALL_VARIABLES,
    SETTINGS_TITLE,
    TITLE,
)

ASKED = (0.3, 0.5, 0.75, 0.9)
STEPS = (1 / 60, 1 / 240, 1 / 1000)
# 1 m/s, below which some engines do not bounce, is a drop of 0.051 m.
DROPS = (0.02, 0.05, 0.1, 1.0, 2.0)
DROPS_OF_SETTINGS = (0.1, 1.0, 2.0)
OF_SETTINGS = 1 / 240
"""The time step in s at which settings vary."""
INSTANTS = 8
NAMES = ("got_mean", "got_least", "got_most")


def dropped(run, asked, step, drop):
    """Mean, least and greatest r of balls that meet the ground at instants within a step."""
    speed = math.sqrt(2 * G * drop)
    drops = drop + speed * step * (np.arange(INSTANTS) / INSTANTS - 0.5)
    got = np.sqrt(rebounds(run(asked, step, drops)) / drops)
    return got.mean(), got.min(), got.max()


def written(name, data, title):
    write_dataset(
        describe(data, ALL_VARIABLES).assign_attrs(title=title, history=MEASURED),
        DATA / f"{name}.nc",
    )


@pytest.fixture(scope="module")
def record():
    """Mean, least and greatest r by engine, step, drop and r; the dataset if none is missing."""
    rows = {}
    yield rows
    if {key[0] for key in rows} != set(BOUNCE):
        return
    shape = (len(BOUNCE), len(STEPS), len(DROPS), len(ASKED))
    found = np.array([rows[key] for key in sorted(rows)]).reshape(*shape, 3)
    dims = ("engine", "time_step", "drop_height", "asked")
    versions = [version(package(name)) for name in sorted(BOUNCE)]
    data = xr.Dataset(
        {name: (dims, found[..., k]) for k, name in enumerate(NAMES)}
        | {"engine_version": ("engine", versions)},
        coords={
            "engine": sorted(BOUNCE),
            "time_step": sorted(STEPS),
            "drop_height": sorted(DROPS),
            "asked": sorted(ASKED),
        },
    )
    written("bounces", data, TITLE)


@pytest.fixture(scope="module")
def settings_record():
    """The same by setting, drop and r."""
    rows = {}
    yield rows
    if {key[0] for key in rows} != set(SETTINGS):
        return
    drops = sorted(DROPS_OF_SETTINGS)
    keys = [(name, drop, r) for name in SETTINGS for drop in drops for r in sorted(ASKED)]
    shape = (len(SETTINGS), len(drops), len(ASKED))
    found = np.array([rows[key] for key in keys]).reshape(*shape, 3)
    dims = ("setting", "drop_height", "asked")
    data = xr.Dataset(
        {name: (dims, found[..., k]) for k, name in enumerate(NAMES)} | {"time_step": OF_SETTINGS},
        coords={"setting": list(SETTINGS), "drop_height": drops, "asked": sorted(ASKED)},
    )
    written("bounce_settings", data, SETTINGS_TITLE)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("drop", DROPS)
@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("name", BOUNCE)
def test_the_bounce_of_an_engine_is_recorded(name, step, drop, asked, record):
    only_if_installed(name)
    got = dropped(BOUNCE[name], asked, step, drop)
    record[name, step, drop, asked] = got
    assert np.all(np.isfinite(got))


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("drop", DROPS_OF_SETTINGS)
@pytest.mark.parametrize("name", SETTINGS)
def test_the_bounce_with_a_setting_is_recorded(name, drop, asked, settings_record):
    only_if_installed(name)
    got = dropped(SETTINGS[name], asked, OF_SETTINGS, drop)
    settings_record[name, drop, asked] = got
    assert np.all(np.isfinite(got))


def test_the_accepted_bounces_are_what_the_page_says():
    data = read_dataset(DATA / "bounces.nc")
    made = dict(zip(data.engine.values.tolist(), data.engine_version.values.tolist(), strict=True))
    assert made == {name: LAST_SEEN[engine_of(name)] for name in BOUNCE}
    at = data.sel(drop_height=1.0)
    off = abs(at.got_mean - at.asked)
    fine, middle = (off.sel(time_step=step) for step in (STEPS[2], STEPS[1]))
    # These are right in the limit of small steps: a step that is four times shorter has less than
    # half of the error.
    for name in ("pymunk", "newton", "dartpy"):
        assert (fine < middle / 2).sel(engine=name).all()
    # Bullet's restitution does not converge with its defaults.
    assert (fine > middle).sel(engine="pybullet").all()
    assert (fine > 0.04).sel(engine="pybullet_tuned").all()
    slow = data.sel(drop_height=[0.02, 0.05], time_step=STEPS[2])
    off = abs(slow.got_mean - slow.asked)
    assert (off.sel(engine=["pymunk", "newton", "dartpy", "rapier"]) < 0.02).all()
    assert (slow.got_mean.sel(engine="pybullet") < 0.2).all()
    # Below Box2D's threshold of 1 m/s the rebound is the same for every r, to single precision.
    alike = slow.got_mean.sel(engine="box2d")
    assert (alike.max("asked") - alike.min("asked") < 1e-6).all()
    coarse = data.sel(time_step=max(STEPS), drop_height=1.0, engine="pymunk")
    assert (coarse.got_most - coarse.got_least).max() > 0.02


def test_the_accepted_settings_are_what_the_page_says():
    data = read_dataset(DATA / "bounces.nc").sel(time_step=OF_SETTINGS)
    varied = read_dataset(DATA / "bounce_settings.nc")
    assert varied.setting.values.tolist() == list(SETTINGS)
    assert varied.time_step == OF_SETTINGS
    moved = {
        name: float(
            abs(
                varied.got_mean.sel(setting=name) - data.got_mean.sel(engine=name.split(":")[0])
            ).max()
        )
        for name in SETTINGS
    }
    # One contact of two bodies needs no iterations: what is left is rounding, in Box2D that of
    # single precision, 6e-8 of heights up to 2 m.
    for name in ("pymunk: iterations 1", "box2d: iterations 1, 1", "mujoco: iterations 1"):
        assert moved[name] < 1e-6
    assert moved["dartpy: detector of Bullet"] < 1e-4
    # Bullet with all of the settings has the bounce of DART.
    bullet = varied.got_mean.sel(setting="pybullet: all of these")
    assert abs(bullet - data.got_mean.sel(engine="dartpy")).max() < 0.001
    # Genesis has the contact of MuJoCo, and its scheme; both compute with double precision.
    apart = data.got_mean.sel(engine="genesis") - data.got_mean.sel(engine="mujoco")
    assert abs(apart).max() < 1e-9
