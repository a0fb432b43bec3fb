"""What engines do under load, at steps that are given: rebound, depth, force, and rest.

A ball is dropped by loops that share no code with the package, with the parameters that the recipe
writes; and in the engines themselves. Heights of the drop are spread over the last step of the
fall, so that the answer's range must contain what each of them does, up to the distance of its own
samples: 257 instants in a step, over which a depth or a force changes by less than itself.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import RUN, Trial
from installed_engines import only_if_installed

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts import Contact, EngineSetup, write_contact
from bouncing_ball_contacts.contact.describe import describe_contact
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.engine import Written
from bouncing_ball_contacts.engines.least_error import stiffness_of_least_error

G = 9.80665
SAMPLE = 1 / 256
NAMES = ("mujoco", "lammps", "pybullet", "drake")


def parameters_of(name, settings, mass):
    """k and c of the spring and the damper that the engine computes, in SI units."""
    found = settings.parameters
    if name == "mujoco":
        return tuple(-mass * x for x in found["solref"])
    if name == "pybullet":
        return found["contactStiffness"] / 2, found["contactDamping"] * 2
    if name == "drake":
        return found["point_contact_stiffness"] / 2, (
            found["point_contact_stiffness"] * found["relaxation_time"]
        )
    return found["kn"], found["gamma_n"] * mass


def dropped(name, k, c, mass, h, height, count, pulls=False):
    """Heights and forces of a ball that is dropped, step by step."""
    x = height
    # LAMMPS' velocities are those of half steps.
    v = G * h / 2 if name == "lammps" else 0.0
    heights, forces = [], []
    for _ in range(count):
        free = v - G * h
        after = free
        if x < 0:
            if name in ("mujoco", "lammps"):
                after = free - h * (k * x + c * v) / mass
            else:
                after = (free - h * k * x / mass) / (1 + h * c / mass + h * h * k / mass)
            if not pulls:
                after = max(after, free)
        forces.append(mass * (after - free) / h)
        v = after
        x += h * v
        heights.append(x)
    return np.array(heights), np.array(forces)


def first_bounce(heights, forces, height, h):
    """Rise, depth and force of the first bounce; the forces are those of the steps."""
    fall = int(math.sqrt(2 * height / G) / h)
    inside = int(np.argmax(heights < 0))
    left = inside + int(np.argmax(heights[inside:] >= 0)) if (heights[inside:] >= 0).any() else -1
    if left < 0:
        return 0.0, -heights.min(), forces.max()
    rise = heights[left : left + fall + 2].max()
    return rise, -heights[inside:left].min(), forces[inside : left + 1].max()


def contains(ends, values, slack):
    """The answer's range contains what single drops do, and is not wider than the slack."""
    for value in values:
        assert ends.least * (1 - slack) - 1e-9 <= value <= ends.most * (1 + slack) + 1e-9


LOOSE = {"restitution_error": 0.01}
DESIGNS = [
    (name, given, step, height)
    for name in NAMES
    for given, step, height in (
        ({"mass": 0.5, "restitution": 0.75}, 1 / 240, 1.0),
        ({"mass": 0.046, "restitution": 0.82}, 2e-3, 0.459),
        ({"mass": 0.5, "restitution": 0.5, "stiffness": 2e4}, 1e-3, 0.3),
        ({"mass": 1.0, "restitution": 0.3, "stiffness": 1e3}, 1 / 240, 0.5),
        ({"mass": 0.02, "restitution": 0.9, "stiffness": 1e5}, 5e-4, 1.0),
        ({"mass": 2.0, "restitution": 0.6}, 5e-3, 0.1),
        ({"mass": 0.5, "restitution": 0.75, "stiffness": 5e3, **LOOSE}, None, 1.0),
        ({"mass": 0.1, "restitution": 0.4, "stiffness": 1e3, **LOOSE}, None, 0.2),
        ({"mass": 5.0, "damping_ratio": 0.3, "stiffness": 1e6}, 1e-3, 1.0),
        ({"mass": 1.0, "damping_ratio": 0.05, "stiffness": 2e3}, 2e-3, 0.05),
    )
]


def design(name, given, step, height):
    options = {"engine": name, "speed": math.sqrt(2 * G * height)}
    if name == "lammps":
        options["release"] = "force"
    if step is not None:
        options["time_step"] = step
    return answered(**given, **options).engine


def of_instants(settings, height):
    """Heights of drops that meet the table at instants within a step, about a height."""
    h = settings.time_step
    return height + math.sqrt(2 * G * height) * h * np.array([-0.43, -0.2, 0.03, 0.26, 0.49])


def count_of(settings, height):
    fall = math.sqrt(2 * height / G)
    return int((2.3 * fall + 4 * settings.steps * settings.time_step) / settings.time_step) + 20


@pytest.mark.parametrize(("name", "given", "step", "height"), DESIGNS)
def test_a_drop_is_that_of_the_steps(name, given, step, height):
    settings = design(name, given, step, height)
    mass, h = given["mass"], settings.time_step
    k, c = parameters_of(name, settings, mass)
    drop = settings.drop
    for start in of_instants(settings, height):
        run = dropped(name, k, c, mass, h, start, count_of(settings, height))
        rise, depth, force = first_bounce(*run, height, h)
        # Relative to its own drop, as the answer's.
        contains(drop.rise, [rise * height / start], 2 * SAMPLE)
        contains(drop.compression, [depth], SAMPLE)
        contains(drop.peak_force, [force], 2 * SAMPLE)
    # A ball that is laid down comes to rest where the parameters carry it.
    assert drop.depth_at_rest == pytest.approx(mass * G / k, rel=1e-11)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("name", "given", "step", "height"), DESIGNS)
def test_a_drop_is_that_of_the_engine(name, given, step, height):
    only_if_installed(name)
    settings = design(name, given, step, height)
    mass, h = given["mass"], settings.time_step
    drop = settings.drop
    for start in of_instants(settings, height)[::2]:
        count = count_of(settings, height)
        trial = Trial(settings, mass, float(start), 0.0, count, gravity=G)
        heights, _ = RUN[name](trial)
        # The force of a step from the velocities before and after it.
        places = np.concatenate([[start, start], heights])
        forces = mass * (np.diff(places, 2) / h**2 + G)
        forces[0] = 0.0
        rise, depth, force = first_bounce(heights, forces, height, h)
        # MuJoCo's impedance 1e-4 and its solver leave 1e-3, as PyBullet's single precision does.
        contains(drop.rise, [rise * height / start], 2 * SAMPLE + 2e-3)
        contains(drop.compression, [depth], SAMPLE + 1e-3)
        contains(drop.peak_force, [force], 2 * SAMPLE + 2e-3)
    # Laid down, it comes to rest: 40 contacts are long enough for r ≤ 0.9.
    long = int(60 * settings.steps) + 200
    if long < 60_000:
        heights, _ = RUN[name](Trial(settings, mass, 0.0, 0.0, long, gravity=G))
        assert -heights[-1] == pytest.approx(drop.depth_at_rest, rel=2e-3)


@pytest.mark.parametrize(
    ("stiffness", "damping", "step"), [(2000.0, 20.0, 0.0041667), (1e5, 50.0, 0.0041667)]
)
def test_parameters_of_a_step_carry_a_ball_at_rest_by_their_own_stiffness(stiffness, damping, step):
    given = {"contactStiffness": stiffness, "contactDamping": damping, "time_step": step}
    contact = Contact(mass=1.0, from_engine="pybullet", parameters=given)
    # The springs of both bodies are in series.
    rest = G / (stiffness / 2)
    assert describe_contact(contact).static_deflection == pytest.approx(rest, rel=1e-12)
    # A ball that creeps: implicit Euler by a loop of 20,000 steps.
    heights, _ = dropped("pybullet", stiffness / 2, 2 * damping, 1.0, step, 0.0, 20_000)
    assert -heights[-1] == pytest.approx(rest, rel=1e-9)


def error_of(name, settings, mass, height, asked):
    k, c = parameters_of(name, settings, mass)
    h = settings.time_step
    found = []
    for start in of_instants(settings, height):
        run = dropped(name, k, c, mass, h, start, count_of(settings, height))
        found.append(math.sqrt(max(first_bounce(*run, height, h)[0], 0.0) / start))
    return max(abs(r - asked) for r in found)


@pytest.mark.parametrize(
    ("name", "mass", "r", "step", "height"),
    [("pybullet", 0.5, 0.75, 1 / 240, 1.0), ("mujoco", 0.046, 0.82, 2e-3, 0.459)],
)
def test_without_a_stiffness_the_contact_has_the_least_error_with_gravity(
    name, mass, r, step, height
):
    settings = design(name, {"mass": mass, "restitution": r}, step, height)
    assert not settings.changed
    own = error_of(name, settings, mass, height, r)
    # Five of the instants in place of all.
    assert own <= settings.drop.error <= own + 0.01
    for factor in (0.25, 0.5, 2.0, 4.0):
        k = settings.contact.stiffness * factor
        other = answered(
            mass=mass, restitution=r, stiffness=k, engine=name, time_step=step,
            restitution_error=0.5, speed=math.sqrt(2 * G * height),
        ).engine  # fmt: skip
        assert not other.changed and other.drop.error > settings.drop.error
        assert error_of(name, other, mass, height, r) > own - 0.003


@pytest.mark.parametrize(
    ("name", "mass", "r", "step"), [("physx", 0.2, 0.7, 1e-3), ("mujoco", 0.2, 0.7, 2e-3)]
)
def test_no_other_damping_is_nearer_to_r_in_the_drop(name, mass, r, step):
    given = Contact(mass=mass, restitution=r)
    settings = write_contact(given, EngineSetup(engine=name, time_step=step))
    k, c = settings.contact[1:]
    critical = 2 * math.sqrt(mass * k)
    for damping in (0.0, *(c + np.array([-0.05, -0.01, 0.01, 0.05]) * critical)):
        if damping >= 0:
            contact = settings.contact._replace(damping=damping)
            written = Written(ENGINES[name], contact, Release.FORCE)
            other = written.drop(step, settings.at_step.steps, 1.0, G, r)
            # The damping has three digits, and the error is at most r for as much damping.
            assert other.error > settings.drop.error - 1e-3 * r


def test_pybullets_restitution_is_named_where_it_is_better():
    settings = write_contact(
        Contact(mass=0.5, restitution=0.75), EngineSetup(engine="pybullet", time_step=1 / 240)
    )
    assert settings.instant_drop.error < settings.drop.error
    assert "restitution=0.866025 " in settings.instant
    # v⁺ = -r (v - gh), by a loop.
    x, v, h, top = 1.0, 0.0, 1 / 240, 0.0
    was_in = False
    for _ in range(300):
        free = v - G * h
        v = -0.75 * free if x < 0 and free < 0 else free
        was_in |= x < 0
        x += h * v
        top = max(top, x) if was_in else 0.0
    contains(settings.instant_drop.rise, [top], SAMPLE)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("height", [0.1, 0.5, 1.0])
def test_pybullets_restitution_is_that_of_the_engine(height):
    only_if_installed("pybullet")
    import pybullet

    settings = design("pybullet", {"mass": 0.5, "restitution": 0.75}, 1 / 240, height)
    pybullet.connect(pybullet.DIRECT)
    pybullet.setPhysicsEngineParameter(
        fixedTimeStep=1 / 240, numSubSteps=1, contactERP=0, restitutionVelocityThreshold=0
    )
    pybullet.setGravity(0, 0, -G)
    table = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=1.0)
    ball = pybullet.createMultiBody(0.5, sphere, basePosition=[0, 0, 1.0 + height])
    for body in (ball, table):
        pybullet.changeDynamics(body, -1, restitution=math.sqrt(0.75), linearDamping=0,
                                contactProcessingThreshold=0)  # fmt: skip
    heights = []
    for _ in range(int(2 * math.sqrt(2 * height / G) * 240)):
        pybullet.stepSimulation()
        heights.append(pybullet.getBasePositionAndOrientation(ball)[0][2] - 1.0)
    pybullet.disconnect()
    inside = int(np.argmax(np.array(heights) < 0))
    contains(settings.instant_drop.rise, [max(heights[inside:])], SAMPLE + 1e-3)


def test_a_loss_by_gravity_is_told_without_a_speed(said):
    text = said("design", "--engine", "mujoco", "--mass", "0.5", "--stiffness", "2000",
                "--restitution", "0.75")  # fmt: skip
    assert "Note: gravity takes 0.0" in text
    stiff = said("design", "--engine", "mujoco", "--mass", "0.5", "--stiffness", "1e8",
                 "--restitution", "0.75")  # fmt: skip
    assert "gravity takes" not in stiff


def test_no_contact_within_an_error_that_is_given_is_refused(refusal):
    with refusal(ModelError, "no contact shorter than"):
        write_contact(
            Contact(mass=0.5, restitution=0.75),
            EngineSetup(engine="drake", time_step=1.0, restitution_error=1e-5),
        )


def of_mujoco(classes=('class="bounce"', 'class="bounce"'), condim=None, cone="pyramidal"):
    """The recipe around a ball that is free, and r and the velocity of an oblique impact."""
    import mujoco

    settings = write_contact(
        Contact(mass=0.5, restitution=0.75, stiffness=1e4), EngineSetup(engine="mujoco")
    )
    text = settings.snippet
    if condim is not None:
        text = text.replace("<geom ", f'<geom condim="{condim}" ')
    plane, sphere = classes
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
{text}
<option gravity="0 0 0" cone="{cone}"/>
<worldbody>
  <geom {plane} type="plane" size="5 5 1"/>
  <body pos="0 0 0.1001"><freejoint/><geom {sphere} type="sphere" size="0.1" mass="0.5"/></body>
  <body pos="2 0 0.1"><freejoint/><geom name="other" type="sphere" size="0.1" mass="0.5"/></body>
</worldbody>
</mujoco>""")
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    data.qvel[2] = -1.0
    for _ in range(4 * settings.steps):
        mujoco.mj_step(model, data)
    other = model.geom("other")
    return data.qvel[2], data.qvel[0], other, settings


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
def test_mujocos_recipe_keeps_friction_and_leaves_other_geoms_alone():
    only_if_installed("mujoco")
    r, along, other, settings = of_mujoco()
    # Friction takes some of the sideways speed, and adds up to 2e-3 to r.
    assert r == pytest.approx(0.75, abs=4e-3) and along < 0.9
    # MuJoCo's defaults.
    assert other.condim == 3 and other.solref == pytest.approx([0.02, 1.0])
    # With a condim of 4 or 6 the pyramid is another contact, and the elliptic cone is not.
    for condim, least in ((4, 0.03), (6, 0.09)):
        assert of_mujoco(condim=condim)[0] < 0.75 - least
        assert of_mujoco(condim=condim, cone="elliptic")[0] == pytest.approx(0.75, abs=4e-3)
    assert 'cone="elliptic"' in settings.snippet


SOLREFS = [
    ("0.02 0.3", "0.9 0.95 0.001", 2e-3, 0.5),
    ("0.02 0.1", "0.5 0.9 0.01", 2e-3, 0.3),
    ("-2e4 -20", "0.95 0.95", 1e-3, 1.0),
    ("0.003 0.2", "0.9 0.95 0.001", 2e-3, 1.0),
    ("-5000 -40", "0.2 0.6 0.05", 1e-3, 0.2),
]


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("solref", "solimp", "step", "height"), SOLREFS)
def test_parameters_with_an_impedance_do_in_a_drop_what_mujoco_does(solref, solimp, step, height):
    only_if_installed("mujoco")
    answer = answered(mass=0.5, from_engine="mujoco", solref=solref, solimp=solimp,
                      time_step=step, speed=math.sqrt(2 * G * height))  # fmt: skip
    drop = answer.dropped_at_step
    text = (
        f'<option timestep="{step!r}"/><default><default class="bounce">'
        f'<geom condim="1" solref="{solref}" solimp="{solimp}"/></default></default>'
    )
    settings = SimpleNamespace(snippet=text, time_step=step, steps=answer.at_step.steps)
    for start in of_instants(settings, height):
        count = int(2.4 * math.sqrt(2 * height / G) / step + 5 * settings.steps) + 20
        heights, _ = RUN["mujoco"](Trial(settings, 0.5, float(start), 0.0, count, gravity=G))
        places = np.concatenate([[start, start], heights])
        forces = 0.5 * (np.diff(places, 2) / step**2 + G)
        forces[0] = 0.0
        rise, depth, force = first_bounce(heights, forces, height, step)
        contains(drop.rise, [rise * height / start], 2 * SAMPLE + 2e-3)
        contains(drop.compression, [depth], SAMPLE + 1e-3)
        contains(drop.peak_force, [force], 2 * SAMPLE + 2e-3)
    if not answer.at_step.is_stable:
        assert drop.depth_at_rest is None
        return
    long = int(100 * settings.steps) + 2000
    heights, _ = RUN["mujoco"](Trial(settings, 0.5, 0.0, 0.0, long, gravity=G))
    assert -heights[-1] == pytest.approx(drop.depth_at_rest, rel=2e-3)


def test_softer_contacts_are_not_tried_once_no_ball_rebounds():
    tried = []

    def found(stiffness, steps):
        tried.append(steps)
        return np.full(3, max(0.0, 0.4 - 0.02 * steps))

    # The error of a ball that stays is r = 0.5, less than twice the least error of 0.26.
    assert stiffness_of_least_error(found, 0.5, 6.4e5) == 1e4
    assert 20 <= max(tried) <= 21
