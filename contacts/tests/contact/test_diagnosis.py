"""What keeps the parameters of an engine from a bounce, and whether the change named helps."""

import math
import re

import numpy as np
import pytest
from asked_contacts import answered
from installed_engines import only_if_installed

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.engines.choice import ENGINES, engine_named

DRAKE = {"point_contact_stiffness": 1e6, "relaxation_time": 0.1, "time_step": 1e-3}


def least(k, c, mass, release_by_force, steps=200_000):
    """r of a free impact by semi-implicit steps, whose error is of the order of their size."""
    omega = math.sqrt(k / mass)
    h = 1e-4 / omega
    x, v = -h / 2, -1.0
    for _ in range(steps):
        push = -(k * x + c * v) / mass
        if (push <= 0 if release_by_force else x >= 0) and v > 0:
            return v
        v += h * push
        x += h * v
    return 0.0


def test_an_overdamped_contact_does_not_bounce_and_the_change_makes_it(said):
    answer = answered(mass=1.0, from_engine="drake", parameters=DRAKE)
    (text,) = answer.diagnosis
    # ζ = c/(2√(km)) with c = τ k of the springs in series.
    k = DRAKE["point_contact_stiffness"] / 2
    zeta = 2 * k * DRAKE["relaxation_time"] / (2 * math.sqrt(k))
    assert text.startswith(f"it does not bounce, because ζ = {zeta:.4g} leaves r = ")
    (time,) = re.findall(r"with relaxation_time = (\S+), of the same stiffness, r is 0.5", text)
    assert least(k, 2 * k * float(time), 1.0, True) == pytest.approx(0.5, abs=2e-3)
    options = [f"--set={name}={value}" for name, value in DRAKE.items()]
    shown = said("design", "--from=drake", "--mass=1", *options)
    # No number of a contact that there is not.
    assert "e+" not in shown.split("Given:")[0] and f"Note: {text}." in shown


@pytest.mark.parametrize("solref", ["0.02 1", "-1e4 -400"])
def test_a_restitution_is_wanted_of_the_parameters(solref):
    answer = answered(mass=2.0, from_engine="mujoco", solref=solref, solimp="1e-4 1e-4",
                      restitution=0.8)  # fmt: skip
    (text,) = answer.diagnosis
    (stiff, lossy) = map(float, re.findall(r"solref = '(\S+) (\S+)'", text)[0])
    assert least(-2 * stiff, -2 * lossy, 2.0, True) == pytest.approx(0.8, abs=2e-3)
    # The parameters that are named need no change.
    again = answered(mass=2.0, from_engine="mujoco", solref=f"{stiff} {lossy}",
                     solimp="1e-4 1e-4", restitution=0.8)  # fmt: skip
    assert again.diagnosis == ()


def test_a_damper_that_pulls_holds_the_ball_which_a_note_says(refusal, said):
    given = {"mass": 1.0, "from_engine": "lammps", "parameters": {"kn": 1e5, "gamma_n": 1000.0}}
    found = answered(**given, restitution=0.7, speed="1 m/s")
    (text,) = found.diagnosis
    assert text.startswith("it does not bounce, because ζ = 1.581 leaves r = 0 at most; with gam")
    (loss,) = re.findall(r"gamma_n = (\S+),", text)
    assert least(1e5, float(loss), 1.0, False) == pytest.approx(0.7, abs=2e-3)
    # The ball sinks in and stays: there is no contact time, no r, and nothing that a step changes.
    contact = found.found
    assert contact.contact_time is None and contact.measured_restitution == 0
    assert contact.static_deflection == pytest.approx(9.80665e-5)
    assert found.dropped.rebound_height == 0 and found.dropped.remarks == ()
    assert answered(**given, time_step=1e-5).at_step is None
    options = ["--from=lammps", "--mass=1", "--set=kn=1e5", "--set=gamma_n=1000"]
    assert "Note: it does not bounce" in said("design", *options)
    # On a table that moves it is no answer.
    with refusal(ModelError, "it does not bounce, because ζ = 1.581 leaves r = 0 at most"):
        answered(**given, frequency="50 Hz", acceleration="2 g")


def test_a_step_that_is_too_long_is_named():
    given = {"contactStiffness": 1e5, "contactDamping": 5.0}
    answer = answered(mass=1.0, from_engine="pybullet", parameters=given, restitution=0.9331,
                      time_step=1 / 240)  # fmt: skip
    (text,) = answer.diagnosis
    (step,) = map(float, re.findall(r"from \d+ on, at (\S+) s, r is within 0.01", text))
    fine = answered(mass=1.0, from_engine="pybullet", parameters=given, time_step=step).at_step
    assert fine.error <= 0.0101 < answer.at_step.error
    assert np.isfinite(fine.mean) and "a contact takes 3.32 steps" in text


@pytest.mark.parametrize("name", ["mujoco", "drake", "newton-semi-implicit"])
def test_an_engine_without_parameters_has_its_defaults(name):
    defaults = dict(ENGINES[name].defaults)
    by_name = {key: defaults.pop(key) for key in ("solref", "solimp") if key in defaults}
    given = answered(mass=1.0, from_engine=name, **by_name, parameters=defaults, restitution=0.8)
    answer = answered(mass=1.0, from_engine=name, restitution=0.8)
    assert answer.diagnosis == given.diagnosis != ()
    assert answer.found.stiffness == given.found.stiffness
    said, *others = answer.found.notes
    assert said.startswith(f"these are the defaults of {name}: ") and tuple(others) == (
        given.found.notes
    )
    # With the time step alone, too.
    at_step = answered(mass=1.0, from_engine=name, time_step="1 ms").at_step
    assert at_step.restitution == given.found.measured_restitution


@pytest.mark.engines
def test_the_defaults_are_those_of_the_engines():
    only_if_installed("mujoco")
    mujoco = pytest.importorskip("mujoco")
    text = "<mujoco><worldbody><geom type='sphere' size='1'/></worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    defaults = ENGINES["mujoco"].defaults
    assert [float(x) for x in defaults["solref"].split()] == model.geom_solref[0].tolist()
    assert [float(x) for x in defaults["solimp"].split()] == model.geom_solimp[0].tolist()
    only_if_installed("drake")
    geometry = pytest.importorskip("pydrake.geometry")
    found = geometry.SceneGraphConfig().default_proximity_properties
    assert ENGINES["drake"].defaults == {
        "point_contact_stiffness": found.point_stiffness,
        "relaxation_time": found.relaxation_time,
    }


def test_engines_of_physx_lead_to_what_is_known(refusal):
    for name in ("isaac", "PhysX", "Isaac-Sim", "isaaclab"):
        assert engine_named(name) is ENGINES["physx"]
    with refusal(ModelError, "a drop of 0.2 m: docs/bounces.md has the bounces of PhysX"):
        engine_named("Unity")
    with refusal(ModelError, "simscape has no time step of its own, and its contact is a law"):
        engine_named("Simscape")


def test_parameters_of_physx_are_read_at_a_step():
    values = {"compliantContactStiffness": 1e4, "compliantContactDamping": 0.0}
    asked = {"mass": 0.5, "from_engine": "physx", "parameters": values, "restitution": 0.9}
    answer = answered(**asked, time_step=1 / 1000)
    # Implicit Euler without damping, as PhysX has it; the step that is named is short enough.
    assert answer.at_step.mean == pytest.approx(0.8014, abs=2.5e-4)
    (text,) = answer.diagnosis[1:]
    (step,) = map(float, re.findall(r"from \d+ on, at (\S+) s, r is within 0.01", text))
    assert answered(**asked, time_step=step).at_step.error <= 0.0101
