"""Balls that are dropped in engines whose restitution is a number, and in some that take k and c.

``python docs/bounces/drops.py [ENGINE]...`` drops them in the engines that are installed, and
writes their lines of docs/data/bounces.csv and docs/data/bounce_settings.csv again; the lines of
other engines stay.

An engine takes r, a time step in s and the heights of drops in m, and returns the heights of the
balls over the ground at all steps, of the shape (steps, drop). The numbers of ground and ball make
r the restitution of their contact: engines multiply, average or compare those of two bodies.
Further arguments are settings of the solver; without them an engine has its defaults.
"""

import csv
import math
import sys
from functools import partial
from pathlib import Path

import numpy as np

from bouncing_ball_contacts import Bounce, design

DOCS = Path(__file__).resolve().parents[1]
sys.path.append(str(DOCS.parent / "tests"))
import engine_runs  # noqa: E402  (the engines that take k and c are run as in the tests)

G = 9.81
RADIUS = 0.1


def steps_of(drop: float, time_step: float) -> int:
    """The steps until an elastic ball is back at the top."""
    return math.ceil(2.1 * math.sqrt(2 * drop / G) / time_step)


def pymunk(restitution, time_step, drops, **settings):
    import pymunk

    space = pymunk.Space()
    for name, value in settings.items():
        setattr(space, name, value)
    space.gravity = (0, -G)
    floor = pymunk.Segment(space.static_body, (-1000, -1), (1000, -1), 1)
    # Chipmunk multiplies the numbers of both shapes.
    floor.elasticity = 1.0
    space.add(floor)
    balls = []
    for place, drop in enumerate(drops):
        body = pymunk.Body(1.0, 1.0)
        body.position = (place, RADIUS + drop)
        shape = pymunk.Circle(body, RADIUS)
        shape.elasticity = restitution
        space.add(body, shape)
        balls.append(body)
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        space.step(time_step)
        heights.append([ball.position.y - RADIUS for ball in balls])
    return np.array(heights)


def pybullet(restitution, time_step, drops, of_bodies=None, **settings):
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -G)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=time_step, **{"numSubSteps": 1} | settings)
    plane = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    # Bullet multiplies the numbers of both bodies.
    pybullet.changeDynamics(plane, -1, restitution=1.0)
    sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=RADIUS)
    balls = []
    for place, drop in enumerate(drops):
        ball = pybullet.createMultiBody(1.0, sphere, basePosition=[place, 0, RADIUS + drop])
        pybullet.changeDynamics(
            ball, -1, restitution=restitution, linearDamping=0, angularDamping=0
        )
        balls.append(ball)
    for body in (plane, *balls):
        pybullet.changeDynamics(body, -1, **of_bodies or {})
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        pybullet.stepSimulation()
        places = [pybullet.getBasePositionAndOrientation(ball)[0][2] for ball in balls]
        heights.append(np.array(places) - RADIUS)
    pybullet.disconnect()
    return np.array(heights)


TUNED = {"restitutionVelocityThreshold": 0, "warmStartingFactor": 0, "contactSlop": 0}
"""The settings that Bullet's author gives in its issue 3094; the next one is of the bodies."""
NOT_AHEAD = {"contactProcessingThreshold": 0}


def pybullet_tuned(restitution, time_step, drops):
    return pybullet(restitution, time_step, drops, of_bodies=NOT_AHEAD, **TUNED)


def newton(restitution, time_step, drops, **settings):
    import newton
    import warp

    warp.config.quiet = True
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -G))
    # XPBD averages the numbers of both shapes.
    material = newton.ModelBuilder.ShapeConfig(
        density=1000.0, mu=0.0, mu_torsional=0.0, mu_rolling=0.0, restitution=restitution
    )
    for place, drop in enumerate(drops):
        start = warp.transform(warp.vec3(float(place), 0.0, RADIUS + drop), warp.quat_identity())
        builder.add_shape_sphere(builder.add_body(xform=start), radius=RADIUS, cfg=material)
    builder.add_ground_plane(cfg=material)
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverXPBD(model, enable_restitution=True, **settings)
    before = model.state()
    after = model.state()
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        before.clear_forces()
        pipeline.collide(before, contacts)
        solver.step(before, after, model.control(), contacts, time_step)
        before, after = after, before
        heights.append(before.body_q.numpy()[:, 2].astype(float) - RADIUS)
    return np.array(heights)


def dartpy(restitution, time_step, drops, detector="FCLCollisionDetector", split=False):
    from dartpy import collision
    from dartpy.dynamics import BoxShape, Skeleton, SphereShape
    from dartpy.simulation import World

    world = World("bounce")
    world.setGravity([0, 0, -G])
    world.setTimeStep(time_step)
    world.getConstraintSolver().setCollisionDetector(getattr(collision, detector)())
    world.getConstraintSolver().setSplitImpulseEnabled(split)

    def add(skeleton, pair, shape, number):
        node = pair[1].createShapeNode(shape)
        node.createCollisionAspect()
        node.createDynamicsAspect()
        # DART multiplies the numbers of both bodies.
        node.getDynamicsAspect().setRestitutionCoeff(number)
        world.addSkeleton(skeleton)

    ground = Skeleton("ground")
    add(ground, ground.createWeldJointAndBodyNodePair(), BoxShape([1000, 10, 1]), 1.0)
    balls = []
    for place, drop in enumerate(drops):
        ball = Skeleton(f"ball {place}")
        pair = ball.createTranslationalJointAndBodyNodePair()
        add(ball, pair, SphereShape(RADIUS), restitution)
        ball.setPositions([place, 0, 0.5 + RADIUS + drop])
        balls.append(ball)
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        world.step()
        heights.append([ball.getPositions()[2] - 0.5 - RADIUS for ball in balls])
    return np.array(heights)


def box2d(restitution, time_step, drops, iterations=(8, 3), **settings):
    import Box2D

    world = Box2D.b2World(gravity=(0, -G), **settings)
    # Box2D takes the larger number of the two.
    world.CreateStaticBody(
        fixtures=Box2D.b2FixtureDef(
            shape=Box2D.b2EdgeShape(vertices=[(-1000, 0), (1000, 0)]), restitution=0.0
        )
    )
    balls = []
    for place, drop in enumerate(drops):
        shape = Box2D.b2CircleShape(radius=RADIUS)
        fixture = Box2D.b2FixtureDef(shape=shape, density=1.0, restitution=restitution)
        balls.append(world.CreateDynamicBody(position=(place, RADIUS + drop), fixtures=fixture))
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        world.Step(time_step, *iterations)
        heights.append([ball.position.y - RADIUS for ball in balls])
    return np.array(heights)


def rapier(restitution, time_step, drops, **settings):
    import rapier3d

    world = rapier3d.PhysicsWorld(gravity=(0, -G, 0))
    world.integration_parameters.dt = time_step
    for name, value in settings.items():
        setattr(world.integration_parameters, name, value)
    # Rapier averages the numbers of both colliders.
    ground = rapier3d.Collider.cuboid(1000, 0.1, 10).translation((0, -0.1, 0))
    world.add_collider(ground.restitution(restitution))
    balls = []
    for place, drop in enumerate(drops):
        ball = rapier3d.RigidBody.dynamic(translation=(place, RADIUS + drop, 0))
        shape = rapier3d.Collider.ball(RADIUS).density(1.0).restitution(restitution)
        balls.append(world.add_body(ball, colliders=[shape]))
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        world.step()
        heights.append([world.rigid_bodies[ball].translation.y - RADIUS for ball in balls])
    return np.array(heights)


def of_contact(name, tolerance=0.02, edits=()):
    """Return drops on the stiffest contact that the step resolves, with edits of its snippet."""

    def run(restitution, time_step, drops):
        bounce = Bounce(mass=1.0, restitution=restitution, speed=2.0, radius=1.0, gravity=G)
        found = design(bounce, name, time_step, tolerance=tolerance, pick="your step")
        written = found.snippet
        for old, new in edits:
            assert old in written
            written = written.replace(old, new)

        class Edited:
            snippet = written
            row = found.row
            one_body = False
            bounce = found.bounce
            engine = name

        # A compliant contact is long: the ball has a half of a second more.
        steps = steps_of(max(drops), time_step) + math.ceil(0.5 / time_step)
        trials = [engine_runs.Trial(Edited, "ball", float(d), 0.0, steps, G) for d in drops]
        return np.stack([engine_runs.RUNS[name](trial)[0] for trial in trials], axis=1)

    return run


ENGINES = {
    "pymunk": pymunk,
    "box2d": box2d,
    "pybullet": pybullet,
    "pybullet_tuned": pybullet_tuned,
    "newton": newton,
    "dartpy": dartpy,
    "rapier": rapier,
    "mujoco": of_contact("mujoco"),
    "lammps": of_contact("lammps"),
    "genesis": of_contact("genesis"),
}


def option(text):
    """Return the edit that adds an option of MuJoCo to a snippet."""
    return (("<option ", f"<option {text} "),)


SETTINGS = {
    "pymunk: iterations 1": partial(pymunk, iterations=1),
    "pymunk: iterations 50": partial(pymunk, iterations=50),
    "pymunk: collision_slop 0": partial(pymunk, collision_slop=0.0),
    "box2d: iterations 1, 1": partial(box2d, iterations=(1, 1)),
    "box2d: iterations 50, 20": partial(box2d, iterations=(50, 20)),
    "box2d: continuousPhysics off": partial(box2d, continuousPhysics=False),
    "pybullet: numSubSteps 4": partial(pybullet, numSubSteps=4),
    "pybullet: numSolverIterations 200": partial(pybullet, numSolverIterations=200),
    "pybullet: contactERP 0": partial(pybullet, contactERP=0),
    "pybullet: threshold 0": partial(pybullet, restitutionVelocityThreshold=0),
    "pybullet: contacts not ahead": partial(pybullet, of_bodies=NOT_AHEAD),
    "pybullet: all of these": partial(pybullet, of_bodies=NOT_AHEAD, contactERP=0, **TUNED),
    "newton: iterations 10": partial(newton, iterations=10),
    "newton: relaxation 1": partial(newton, rigid_contact_relaxation=1.0),
    "dartpy: detector of Bullet": partial(dartpy, detector="BulletCollisionDetector"),
    "dartpy: split impulse": partial(dartpy, split=True),
    "rapier: iterations 1": partial(rapier, num_solver_iterations=1),
    "rapier: iterations 16": partial(rapier, num_solver_iterations=16),
    "rapier: prediction 0": partial(rapier, normalized_prediction_distance=0.0),
    "rapier: prediction 0.1": partial(rapier, normalized_prediction_distance=0.1),
    "mujoco: iterations 1": of_contact("mujoco", edits=option('iterations="1"')),
    "mujoco: implicitfast": of_contact("mujoco", edits=option('integrator="implicitfast"')),
    "mujoco: RK4": of_contact("mujoco", edits=option('integrator="RK4"')),
    "mujoco: default impedance": of_contact(
        "mujoco", edits=(("0.0001 0.0001 0.001", "0.9 0.95 0.001"),)
    ),
    "mujoco: error 0.1": of_contact("mujoco", tolerance=0.1),
    "lammps: limit_damping": of_contact("lammps-limit-damping"),
    "lammps: error 0.1": of_contact("lammps", tolerance=0.1),
}
"""Settings of the solvers, one after another; the name of the engine is before the colon."""
ASKED = (0.3, 0.5, 0.75, 0.9)
STEPS = (1 / 60, 1 / 240, 1 / 1000)
DROPS = (0.02, 0.05, 0.1, 1.0, 2.0)
DROPS_OF_SETTINGS = (0.1, 1.0, 2.0)
STEP_OF_SETTINGS = 1 / 240
INSTANTS = 8


def rebounds(heights):
    """Return the greatest height after the first impact of each ball."""
    tops = []
    for column in heights.T:
        rising = np.flatnonzero(np.diff(column) > 0)
        first = rising[0] if rising.size else column.size - 1
        tops.append(max(column[first:].max(), 0.0))
    return np.array(tops)


def dropped(run, asked, step, drop):
    """Return mean, least and greatest r of balls that meet the ground at instants within a step."""
    speed = math.sqrt(2 * G * drop)
    drops = drop + speed * step * (np.arange(INSTANTS) / INSTANTS - 0.5)
    got = np.sqrt(rebounds(run(asked, step, drops)) / drops)
    return [f"{value:.4f}" for value in (got.mean(), got.min(), got.max())]


def replaced(path, key, lines):
    """Write lines in place of those with the same first columns."""
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    new = {tuple(line[:key]): line for line in lines}
    rows = [new.pop(tuple(row[:key]), row) for row in rows]
    with path.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows, *new.values()])


def main():
    wanted = sys.argv[1:]
    lines = []
    of_settings = []
    for name, run in ENGINES.items():
        if wanted and name not in wanted:
            continue
        try:
            for step in sorted(STEPS):
                for drop in DROPS:
                    for asked in ASKED:
                        found = dropped(run, asked, step, drop)
                        lines.append([name, f"{step:.5f}", f"{drop:g}", f"{asked:g}", *found])
        except ImportError as missing:
            print(f"{name}: {missing.name} is not installed")
    for name, run in SETTINGS.items():
        if wanted and name.split(":")[0] not in wanted:
            continue
        try:
            for drop in DROPS_OF_SETTINGS:
                for asked in ASKED:
                    found = dropped(run, asked, STEP_OF_SETTINGS, drop)
                    of_settings.append([name, f"{drop:g}", f"{asked:g}", *found])
        except ImportError as missing:
            print(f"{name}: {missing.name} is not installed")
    replaced(DOCS / "data" / "bounces.csv", 4, lines)
    replaced(DOCS / "data" / "bounce_settings.csv", 3, of_settings)
    print(f"{len(lines)} and {len(of_settings)} lines")


if __name__ == "__main__":
    main()
