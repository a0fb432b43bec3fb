"""Recipes that users asked for: Hertz in LAMMPS and LIGGGHTS, and PyBullet's contacts."""

import json
import math

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import RADIUS, Trial, lammps
from installed_engines import only_if_installed
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.contact.texts import shown

HERTZ = {"mass": 0.02, "radius": RADIUS, "reduced_modulus": "1 GPa", "speed": "1 m/s"}


@pytest.mark.parametrize("restitution", [0.5, 0.8])
def test_a_hertz_recipe_has_the_modulus_and_the_restitution(restitution):
    given = HERTZ | {"radius": "5 mm", "restitution": restitution}
    found = answered(**given, engine="lammps").engine
    # F = (4/3) E* √R δ^{3/2}, of which LAMMPS multiplies the root itself.
    modulus, r = found.parameters.values()
    assert modulus == pytest.approx(4 / 3 * 1e9, rel=1e-11) and r == pytest.approx(restitution)
    young, ratio, same = answered(**given, engine="liggghts").engine.parameters.values()
    # Of two alike bodies.
    assert young[0] == young[1] and ratio[0] == ratio[1]
    assert young[0] / (2 * (1 - ratio[0] ** 2)) == pytest.approx(1e9, rel=1e-11)
    assert same == pytest.approx(restitution)
    # By an integration of that law: C = -√5 ln r/√(ln² r + π²) (Antypov and Elliott, 2011).
    k = modulus * math.sqrt(0.005) / 0.02
    log = math.log(restitution)
    damping = -math.sqrt(5) * log / math.hypot(log, math.pi) * math.sqrt(k)

    def motion(t, y):
        p = max(y[0], 0.0)
        return [y[1], -k * p**1.5 - damping * p**0.25 * y[1]]

    def left(t, y):
        return y[0] if t > 0 else 1.0

    left.terminal = True
    left.direction = -1
    run = solve_ivp(motion, (0, 1), [0.0, 1.0], events=left, rtol=1e-10, atol=1e-14,
                    first_step=1e-9)  # fmt: skip
    assert -run.y[1, -1] == pytest.approx(restitution, abs=1e-6)
    duration = run.t[-1]
    assert found.time_step * found.steps == pytest.approx(duration, rel=1e-5)


def test_the_step_of_a_hertz_recipe_stands_beside_the_rayleigh_time(said):
    ball = ("--mass=4 g", "--radius=5 mm", "--restitution=0.8", "--speed=1 m/s", "--engine=lammps")
    solids = ("--youngs-modulus=5 MPa", "--poissons-ratio=0.45", "--table-youngs-modulus=2 GPa",
              "--table-poissons-ratio=0.2")  # fmt: skip
    text = said("design", *ball, *solids)
    density = 0.004 / (4 / 3 * math.pi * 0.005**3)
    wave = math.sqrt(5e6 / (2 * 1.45) / density) * (0.1631 * 0.45 + 0.8766)
    time = math.pi * 0.005 / wave
    assert f"of the Rayleigh time of the ball, {shown(time, 's')}." in text
    step = json.loads(said("design", *ball, *solids, "--json"))["engine"]["time_step"]
    assert f"The step is {shown(step / time, '%')} of" in text
    assert "Rayleigh" not in said("design", *ball, "--reduced-modulus=5 MPa")


def test_liggghts_gets_the_materials_that_were_given():
    given = {"mass": "4 g", "radius": "5 mm", "restitution": 0.8, "speed": "1 m/s"}
    solids = {"youngs_modulus": "5 MPa", "poissons_ratio": 0.45,
              "table_youngs_modulus": "2 GPa", "table_poissons_ratio": 0.2}  # fmt: skip
    found = answered(**given, **solids, engine="liggghts").engine
    assert found.parameters["youngsModulus"] == [5e6, 2e9]
    assert found.parameters["poissonsRatio"] == [0.45, 0.2]
    assert "peratomtype 5000000.0 2000000000.0" in found.snippet
    # They have the E* of the contact, which LAMMPS gets.
    star = 1 / ((1 - 0.45**2) / 5e6 + (1 - 0.2**2) / 2e9)
    other = answered(**given, **solids, engine="lammps").engine
    assert other.parameters["hertz"] == pytest.approx(4 / 3 * star, rel=1e-11)


@pytest.mark.engines
@pytest.mark.parametrize("restitution", [0.5, 0.8, 0.95])
def test_lammps_has_the_restitution_of_the_hertz_recipe_at_every_speed(restitution):
    only_if_installed("lammps")
    found = answered(**HERTZ, restitution=restitution, engine="lammps").engine
    step = found.time_step
    for speed in (1.0, 0.1):
        for fraction in (0.02, 0.5, 0.98):
            # A contact lasts as v^{-1/5}.
            steps = int(2 * found.steps * speed**-0.2)
            away, _ = lammps(Trial(found, 0.02, fraction * step * speed, -speed, steps))
            r = (away[-1] - away[-2]) / step / speed
            # The step is that of the linear contact with this r, at the speed of 1 m/s.
            assert r == pytest.approx(restitution, abs=1.05 * found.error)


def test_a_hertz_recipe_needs_the_radius_of_the_sphere(refusal):
    given = {"mass": "20 g", "law": "tsuji", "contact_time": "1 ms", "restitution": 0.8}
    with refusal(ModelError, "radius of the sphere is missing: lammps multiplies"):
        answered(**given, speed="1 m/s", engine="lammps")
    with refusal(ModelError, "a Hertz contact is not written for mujoco"):
        answered(**HERTZ, restitution=0.8, engine="mujoco")


COARSE = {"mass": 0.5, "stiffness": 1e5, "restitution": 0.75, "time_step": "4 ms"}


def test_pybullets_restitution_is_said_where_a_step_is_too_long(said, refused):
    found = answered(**COARSE, engine="pybullet").engine
    assert found.instant.startswith("restitution=0.866025 of ball and table alike")
    text = said("design", "--engine=pybullet", "--mass=0.5", "--stiffness=1e5",
                "--restitution=0.75", "--time-step=4 ms")  # fmt: skip
    assert found.instant in text
    assert answered(**COARSE, engine="mujoco").engine.instant == ""
    _, line = refused("design", "--from=pybullet", "--mass=0.5", "--set=restitution=0.9")
    assert "restitution of pybullet has no stiffness: if ball and table have it, r = 0.81" in line


@pytest.mark.engines
@pytest.mark.parametrize("step", [1 / 60, 1 / 240, 1e-3])
def test_pybullet_itself_has_this_restitution_without_a_spring(step):
    only_if_installed("pybullet")
    import pybullet

    def bounce(fraction, ahead, erp):
        pybullet.connect(pybullet.DIRECT)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=step, numSubSteps=1, restitutionVelocityThreshold=0, contactERP=erp
        )
        table = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
        sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=RADIUS)
        height = RADIUS + (3 + fraction) * step
        ball = pybullet.createMultiBody(0.5, sphere, basePosition=[0, 0, height])
        threshold = {} if ahead else {"contactProcessingThreshold": 0}
        for body in (ball, table):
            pybullet.changeDynamics(body, -1, restitution=math.sqrt(0.75), linearDamping=0,
                                    angularDamping=0, **threshold)  # fmt: skip
        pybullet.resetBaseVelocity(ball, [0, 0, -1])
        for _ in range(10):
            pybullet.stepSimulation()
        found = pybullet.getBaseVelocity(ball)[0][2]
        pybullet.disconnect()
        return found

    places = np.linspace(0.02, 0.98, 5)
    assert [bounce(f, False, 0) for f in places] == pytest.approx([0.75] * 5, abs=1e-6)
    # Bullet's default pushes the ball out of the table besides, and contacts ahead stop it.
    assert max(bounce(f, False, 0.08) for f in places) == pytest.approx(0.75 + 0.08, abs=0.01)
    assert max(bounce(f, True, 0.08) for f in places) < 0.01


@pytest.mark.parametrize("step", [1e-4, 1e-3])
def test_pybullets_springs_give_the_erp_and_cfm_of_a_constraint(step):
    """erp = h k/(h k + c) and cfm = 1/(h k + c), of springs in series and added dampers."""
    given = {"mass": 0.5, "stiffness": 2e3, "restitution": 0.6, "engine": "pybullet"}
    found = answered(**given, time_step=step).engine
    k = found.parameters["contactStiffness"] / 2
    c = found.parameters["contactDamping"] * 2
    erp = step * k / (step * k + c)
    cfm = 1 / (step * k + c)
    x = -0.5 * step
    v = -1.0
    while x < 0:
        # A force f ≥ 0 with v⁺ = (erp/h) p - cfm f and m v⁺ = m v + h f.
        f = max((erp / step * -x - v) / (cfm + step / 0.5), 0.0)
        v += step * f / 0.5
        x += step * v
    at = found.at_step
    assert at.least - 1e-9 <= v <= at.most + 1e-9
    both = ", ".join(f"{name}={value}" for name, value in found.parameters.items())
    assert both in found.snippet


def test_json_of_a_recipe_has_no_number_that_is_none(outcome):
    """Of a law whose steps are not known there is no drop."""
    given = ("design", "--engine=lammps", "--mass=1", "--radius=5 mm", "--reduced-modulus=1 GPa",
             "--restitution=0.8", "--speed=1 m/s", "--json")  # fmt: skip
    _, text, _ = outcome(*given)

    def refuse(constant):
        raise AssertionError(constant)

    engine = json.loads(text, parse_constant=refuse)["engine"]
    assert engine["drop"] is None and engine["wanted"] is None
