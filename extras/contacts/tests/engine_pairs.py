"""Bodies of other materials, with defaults or with a restitution by number, in engines.

``python tests/engine_pairs.py [ENGINE]...`` drops a ball of 1 kg and a radius of 0.1 m from 0.5 m,
at 16 instants within a step, and prints r and the depth at rest: as diagnosed, and in the engine.
Then it drops them with friction and a speed along the table. The rows are saved in
docs/validation/diagnoses.csv. The exit status is 1 if one differs.
"""

import math
import sys
from dataclasses import replace
from types import SimpleNamespace
from typing import NamedTuple

import engine_runs
import numpy as np
from engine_page import KEPT, save

from bouncing_ball_contacts import ENGINES, Bounce, diagnose
from bouncing_ball_contacts.designs import Problem
from bouncing_ball_contacts.rows import BY_NUMBER

HEIGHT = 0.5
G = 9.80665
BALL = Bounce(mass=1.0, drop_height=HEIGHT, radius=0.1)
SHORT = 1e-3
LONG = 1 / 240


class Rub(NamedTuple):
    """The friction of both bodies, None for the default of the engine, and a speed along in m/s."""

    friction: float | None = None
    slide: float = 0.0


def mujoco(one, other, height, step, rub):
    import mujoco

    def geom(values):
        values = values if rub.friction is None else {**values, "friction": rub.friction}
        return " ".join(f'{name}="{value}"' for name, value in values.items())

    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step}" gravity="0 0 {-G}"/><worldbody>
        <geom type="plane" size="1 1 1" {geom(other)}/>
        <body pos="0 0 {0.1 + height}"><freejoint/><geom size="0.1" mass="1" {geom(one)}/></body>
        </worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[0] = rub.slide
    heights = []
    for _ in range(20000):
        mujoco.mj_step(model, data)
        heights.append(data.qpos[2] - 0.1)
    return heights


def pybullet(one, other, height, step, rub):
    import pybullet

    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -G)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=step, numSubSteps=1)
    table = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.1)
    ball = pybullet.createMultiBody(1, sphere, basePosition=[0, 0, 0.1 + height])
    for body, values in ((ball, one), (table, other)):
        for name, value in values.items():
            if name in WORLD:
                pybullet.setPhysicsEngineParameter(**{name: value})
        pybullet.changeDynamics(
            body, -1, **{name: value for name, value in values.items() if name not in WORLD}
        )
        if rub.friction is not None:
            pybullet.changeDynamics(body, -1, lateralFriction=math.sqrt(rub.friction))
    pybullet.resetBaseVelocity(ball, [rub.slide, 0, 0])
    heights = []
    for _ in range(20000):
        pybullet.stepSimulation()
        heights.append(pybullet.getBasePositionAndOrientation(ball)[0][2] - 0.1)
    return heights


def drake(one, other, height, step, rub):
    import pydrake.all as pydrake

    builder = pydrake.DiagramBuilder()
    near = "sap" if "relaxation_time" in one else "lagged"
    config = pydrake.MultibodyPlantConfig(time_step=step, discrete_contact_approximation=near)
    plant, _ = pydrake.AddMultibodyPlant(config, builder)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -G])
    inertia = pydrake.SpatialInertia.SolidSphereWithMass(1.0, 0.1)
    ball = plant.AddRigidBody("ball", inertia)
    shapes = {
        plant.world_body(): (pydrake.HalfSpace(), other, -0.1 - height),
        ball: (pydrake.Sphere(0.1), one, 0.0),
    }
    for body, (shape, values, place) in shapes.items():
        properties = pydrake.ProximityProperties()
        friction = pydrake.CoulombFriction(rub.friction or 0, rub.friction or 0)
        pydrake.AddContactMaterial(
            values.get("hunt_crossley_dissipation"),
            values.get("point_contact_stiffness"),
            friction,
            properties,
        )
        if "relaxation_time" in values:
            properties.AddProperty("material", "relaxation_time", values["relaxation_time"])
        here = pydrake.RigidTransform([0, 0, place])
        plant.RegisterCollisionGeometry(body, here, shape, body.name(), properties)
    plant.Finalize()
    log = pydrake.LogVectorOutput(plant.get_state_output_port(), builder, step)
    simulator = pydrake.Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetVelocities(context, [0, 0, 0, rub.slide, 0, 0])
    simulator.AdvanceTo(20.0)
    return log.FindLog(simulator.get_context()).data()[6, 1:] + height


def run_alone(run, seconds):
    """Return the drop of a design of :mod:`engine_runs` with these parameters."""
    return lambda one, other, height, step, rub: run(trial(one, height, step, seconds, rub))[0]


def trial(one, height, step, seconds, rub, snippet=""):
    written = SimpleNamespace(parameters=one, snippet=snippet, bounce=BALL, time_step=step)
    steps = int(seconds / step)
    rubs = (rub.friction or 0.0, rub.slide)
    return engine_runs.Trial(written, "ball", float(height), 0.0, steps, G, *rubs)


def ode(one, other, height, step, rub):
    modes = ("Bounce", "SoftERP", "SoftCFM", "Approx1")
    lines = [f"contact.surface.mode = {' | '.join(f'dContact{mode}' for mode in modes)};"]
    # Those of a world of double precision, and no bounce.
    values = {"bounce": 0.0, "bounce_vel": 0.0, **ENGINES["ode"].defaults, **one}
    lines += [f"contact.surface.{name} = {value!r};" for name, value in values.items()]
    lines += [f"dWorldStep(world, {step!r});"]
    return engine_runs.ode(trial(one, height, step, 60.0, rub, "\n".join(lines)))[0]


GAZEBO = run_alone(engine_runs.gazebo, 20.0)


def physx(one, other, height, step, rub):
    """PhysX takes 10 ms for a step. The defaults of a table are rigid."""
    return engine_runs.physx(trial(one, height, step, 1.2, rub), other or {})[0]


DIRECT = {"solref": "-20000 -30", "solimp": "1e-4 1e-4 0.001"}
AHEAD = {"contactProcessingThreshold": 0.0, "contactSlop": 0.0}
SPRING = {"contactStiffness": 2e4, "contactDamping": 10.0, "linearDamping": 0.0, **AHEAD}
UNDISTURBED = {**BY_NUMBER["pybullet"].designed[0], "restitutionVelocityThreshold": 0.0}
WORLD = ("contactERP", "contactSlop", "restitutionVelocityThreshold")
SAP = {"point_contact_stiffness": 2e4, "relaxation_time": 0.002}
LAGGED = {"point_contact_stiffness": 2e4, "hunt_crossley_dissipation": 0.1}
SOFT = {"contactStiffness": 1e4, "contactDamping": 1.5}
HARD = {"contactStiffness": 2e5, "contactDamping": 10.0}
COMPLIANT = {"compliantContactStiffness": 2e4, "compliantContactDamping": 30.0}
STIFFER = {"compliantContactStiffness": 4e4, "compliantContactDamping": 10.0}
# Their product is a stiffness of 60 kN/m.
PRODUCT = (
    {"compliantContactStiffness": 200.0, "compliantContactDamping": 30.0},
    {
        "compliantContactStiffness": 300.0,
        "compliantContactDamping": 10.0,
        "restitutionCombineMode": "multiply",
    },
)
# Engine, its drop, the parameters of the ball and of the table, and the step in s; None are the
# defaults.
CASES = [
    ("mujoco", mujoco, DIRECT, None, SHORT),
    ("mujoco", mujoco, DIRECT, {"solref": "-5000 -60", "solimp": "0.2 0.2 0.001"}, SHORT),
    ("mujoco", mujoco, {"solref": "0.05 0.1"}, {"solref": "0.02 0.3"}, SHORT),
    ("pybullet", pybullet, SPRING, None, SHORT),
    ("pybullet", pybullet, SPRING, {"contactStiffness": 1e4, "contactDamping": 2.0}, SHORT),
    ("pybullet", pybullet, SOFT, SOFT, SHORT),
    ("pybullet", pybullet, HARD, HARD, SHORT),
    ("pybullet", pybullet, {"contactStiffness": 1e5, "contactDamping": 30.0}, None, LONG),
    *(
        ("pybullet", pybullet, both, both, LONG)
        for both in (
            {"restitution": 0.9},
            {"restitution": 0.5},
            {"restitution": 0.9, "linearDamping": 0.0, "contactERP": 0.0},
            {"restitution": 0.9, **UNDISTURBED},
            {},
        )
    ),
    ("pybullet", pybullet, {"restitution": 0.9}, {"restitution": 0.7}, LONG),
    *(
        ("ode", ode, both, both, 0.01)
        for both in (
            {"bounce": 0.9},
            {"bounce": 0.9, "soft_cfm": 1e-3},
            {"bounce": 0.6, "soft_cfm": 2e-3, "soft_erp": 0.8},
        )
    ),
    *(
        ("gazebo", GAZEBO, both, both, SHORT)
        for both in (
            {"kp": 2e5, "kd": 5.0, "max_vel": 3.0},
            {"kp": 2e5, "kd": 5.0, "max_vel": 1.0},
            {"kp": 2e5, "kd": 5.0},
            {"restitution_coefficient": 0.9, "threshold": 0.0, "max_vel": 100.0},
            {"restitution_coefficient": 0.9, "threshold": 0.0},
        )
    ),
    *(
        ("isaac-lab", physx, both, both, LONG)
        for both in ({"restitution": 0.5}, {"restitution": 0.9}, {"restitution": 0.0})
    ),
    ("physx", physx, COMPLIANT, None, SHORT),
    ("physx", physx, COMPLIANT, {"compliantContactDamping": 60.0}, SHORT),
    *(
        ("physx", physx, COMPLIANT, STIFFER | {"restitutionCombineMode": mode}, SHORT)
        for mode in ("average", "min", "max")
    ),
    ("physx", physx, *PRODUCT, SHORT),
    ("drake-sap", drake, SAP, {"point_contact_stiffness": 6e4, "relaxation_time": 0.001}, SHORT),
    ("drake-sap", drake, SAP, None, SHORT),
    (
        "drake",
        drake,
        LAGGED,
        {"point_contact_stiffness": 8e4, "hunt_crossley_dissipation": 0.8},
        SHORT,
    ),
]


def in_words(parameters):
    return (
        ", ".join(f"{name} = {value}" for name, value in (parameters or {}).items()) or "defaults"
    )


def rebound(heights, height):
    """Return √(h′/h) of the first bounce."""
    turn = int(np.argmax(np.diff(heights) >= -1e-9))
    return math.sqrt(max(heights[turn:].max(), 0.0) / height)


def cells(case, rub):
    """Return the cells of a row of a table, and whether the engine agrees with the diagnosis."""
    name, run, one, other, step = case
    is_told = (
        rub.friction is not None and "friction" in ENGINES[engine_runs.ROWS.get(name, name)].rules
    )
    rubs = {"friction": rub.friction} if is_told else {}
    differs = None if other == one else {**(other or {}), **rubs}
    diagnosis = diagnose(BALL, name, {**one, **rubs}, step, other=differs)
    way = math.sqrt(2 * G * HEIGHT) * step
    measured = []
    for height in HEIGHT + way * np.linspace(0, 1, 16):
        heights = np.asarray(run(one, other or {}, height, step, rub))
        measured.append(rebound(heights, height))
    # A ball that is still on its way at the end has no depth at rest.
    last = heights[-200:]
    is_still = np.ptp(last) < 1e-4
    rest = -float(np.mean(last)) if is_still else math.nan
    low, mean, high = diagnosis.outcome.restitution
    least, most = low, high
    if rub.slide and "stiffness" in diagnosis.numbers:
        problem = Problem(replace(BALL, restitution=mean), ENGINES[name])
        least, most = problem.promised(diagnosis.outcome)
    agrees = least - 1e-3 <= min(measured) and max(measured) <= most + 1e-3
    if (least, most) == (low, high):
        # The mean is over 16 instants here, and over neighbouring steps in a diagnosis.
        agrees &= abs(np.mean(measured) - mean) < 0.01 + (high - low) / 16
    # Without a threshold the ball never comes to rest, and a depth may be too small.
    has_rest = bool(diagnosis.outcome.rest)
    lies = not has_rest or np.isclose(rest, diagnosis.outcome.rest, rtol=0.02)
    agrees &= not is_still or bool(lies)
    table = "the same" if other is one else in_words(other)
    texts = [name, in_words(one), table, f"{step * 1e3:.4g}", f"{low:.4f} to {high:.4f}"]
    texts += [f"{min(measured):.4f} to {max(measured):.4f}"]
    rests = (diagnosis.outcome.rest, rest) if has_rest else (math.nan, math.nan)
    texts += ["–" if math.isnan(depth) else f"{depth * 1e3:.4g}" for depth in rests]
    return texts, agrees


HEAD = [
    "engine",
    "friction",
    "ball",
    "table",
    "step, ms",
    "r",
    "r in the engine",
    "at rest, mm",
    "at rest in the engine, mm",
    "promise",
]
RUBBED = Rub(0.3, 1.0)


def table(cases, rub):
    """Return the rows of a table."""
    rows = []
    for case in cases:
        try:
            texts, agrees = cells(case, rub)
        except ImportError as missing:
            print(f"Not run, because it is not installed: {case[0]} ({missing.name}).")
            continue
        rows.append([texts[0], f"{rub.friction or 0:g}", *texts[1:], KEPT[bool(agrees)]])
        print(" | ".join(rows[-1]), flush=True)
    return rows


def main():
    cases = [case for case in CASES if not sys.argv[1:] or case[0] in sys.argv[1:]]
    rows = table(cases, Rub()) + table([case for case in cases if case[0] != "gazebo"], RUBBED)
    save("diagnoses", HEAD, rows)
    differ = sum(row[-1] == KEPT[False] for row in rows)
    print(f"{len(rows) - differ} of {len(rows)} diagnoses agree with their engines.")
    sys.exit(differ > 0)


if __name__ == "__main__":
    main()
