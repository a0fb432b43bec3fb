"""Drops in the engines themselves: the ball rebounds as the recipe promises, with gravity."""

import math

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import RUN, Trial
from installed_engines import only_if_installed

from bouncing_ball_contacts import Contact, EngineSetup, Table, write_contact

G = 9.80665


def rebound(name, settings, mass, drop):
    """The height to which a ball rises in an engine that is dropped from a height in m."""
    fall = math.sqrt(2 * drop / G)
    # The fall, a contact, and the whole rebound.
    steps = int((2.2 * fall + 2 * settings.steps * settings.time_step) / settings.time_step)
    heights, _ = RUN[name](Trial(settings, mass, drop, 0.0, steps, gravity=G))
    lowest = int(np.argmin(heights[: int(1.4 * fall / settings.time_step)]))
    return float(np.max(heights[lowest:]))


def tolerance(settings, drop):
    """The error of a rebound's height in m that the answer names, beside rounding in the engine."""
    error = settings.drop.error
    return (2 * settings.wanted * error + error**2 + 1e-3) * drop


DROPS = [
    ("mujoco", {"contact_time": "50 ms", "drop_height": "20 cm", "rebound_height": "4 cm"}),
    ("mujoco", {"contact_time": "50 ms", "drop_height": "10 cm", "rebound_height": "9 mm"}),
    ("mujoco", {"stiffness": "5 kN/m", "drop_height": "1 m", "rebound_height": "56 cm"}),
    ("mujoco", {"time_step": "1 ms", "drop_height": "50 cm", "rebound_height": "20 cm"}),
    ("lammps", {"contact_time": "50 ms", "drop_height": "20 cm", "rebound_height": "4 cm"}),
    (
        "lammps",
        {"stiffness": "5 kN/m", "drop_height": "1 m", "rebound_height": "56 cm"}
        | {"release": "force"},
    ),
    ("pybullet", {"contact_time": "50 ms", "drop_height": "20 cm", "rebound_height": "4 cm"}),
]


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("name", "given"), DROPS)
def test_a_dropped_ball_rebounds_to_the_height_that_was_measured(name, given):
    only_if_installed(name)
    found = answered(mass=0.5, engine=name, **given)
    drop, height = (float(given[x].split()[0]) for x in ("drop_height", "rebound_height"))
    units = {"cm": 0.01, "mm": 0.001, "m": 1.0}
    drop *= units[given["drop_height"].split()[1]]
    height *= units[given["rebound_height"].split()[1]]
    allowed = tolerance(found.engine, drop)
    assert rebound(name, found.engine, 0.5, drop) == pytest.approx(height, abs=allowed)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("name", ["mujoco", "lammps"])
@pytest.mark.parametrize("speed", [4.0, 0.4])
def test_a_recipe_says_how_r_falls_for_slower_impacts(name, speed):
    only_if_installed(name)
    found = answered(mass=0.5, stiffness=2e4, restitution=0.75, engine=name, speed=speed)
    fast = rebound(name, found.engine, 0.5, found.dropped.drop_height)
    allowed = tolerance(found.engine, found.dropped.drop_height)
    assert fast == pytest.approx(found.dropped.rebound_height, abs=allowed)
    slow = rebound(name, found.engine, 0.5, found.dropped.drop_height / 4)
    assert math.sqrt(4 * slow / found.dropped.drop_height) == pytest.approx(
        found.dropped.at_half, abs=1.2 * found.engine.error
    )


def test_a_recipe_of_three_dataclasses_is_that_of_a_design():
    contact = Contact(mass=0.5, stiffness=1e5, restitution=0.75)
    table = Table(frequency="20 Hz", acceleration="0.8 g")
    found = write_contact(contact, EngineSetup(engine="lammps"), table)
    whole = answered(
        mass=0.5, stiffness=1e5, restitution=0.75, engine="lammps", frequency=20,
        acceleration="0.8 g",
    )  # fmt: skip
    assert found == whole.engine
