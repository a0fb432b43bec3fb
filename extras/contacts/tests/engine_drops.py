"""Balls that are dropped in engines that have a wheel and whose restitution is a number.

``python tests/engine_drops.py [ENGINE]...`` prints the lines of engine_drops.csv of the engines
that are installed, measured again. ``engine_drops.mjs`` does the same for those of JavaScript.

An engine takes r, a step in s, the heights of drops and a radius in m, and the number of steps, and
returns the heights of the balls over the surface, of the shape (steps, drop).
"""

import csv
import math
import shutil
import subprocess
import sys
import tempfile
from glob import glob
from pathlib import Path

import numpy as np

G = 9.81
INSTANTS = 8
FILE = Path(__file__).with_suffix(".csv")


def chipmunk(r, step, drops, radius, steps):
    import pymunk

    space = pymunk.Space()
    space.gravity = (0, -G)
    floor = pymunk.Segment(space.static_body, (-1000, -1), (1000, -1), 1)
    floor.elasticity = 1.0
    space.add(floor)
    balls = []
    for place, drop in enumerate(drops):
        body = pymunk.Body(1.0, 1.0)
        body.position = (3 * place, radius + drop)
        shape = pymunk.Circle(body, radius)
        shape.elasticity = r
        space.add(body, shape)
        balls.append(body)
    heights = []
    for _ in range(steps):
        space.step(step)
        heights.append([ball.position.y - radius for ball in balls])
    return np.array(heights)


def dart(r, step, drops, radius, steps):
    from dartpy.dynamics import BoxShape, Skeleton, SphereShape
    from dartpy.simulation import World

    world = World("bounce")
    world.setGravity([0, 0, -G])
    world.setTimeStep(step)

    def add(skeleton, pair, shape, number):
        node = pair[1].createShapeNode(shape)
        node.createCollisionAspect()
        node.createDynamicsAspect()
        node.getDynamicsAspect().setRestitutionCoeff(number)
        world.addSkeleton(skeleton)

    ground = Skeleton("ground")
    add(ground, ground.createWeldJointAndBodyNodePair(), BoxShape([1000, 10, 1]), 1.0)
    balls = []
    for place, drop in enumerate(drops):
        ball = Skeleton(f"ball {place}")
        pair = ball.createTranslationalJointAndBodyNodePair()
        add(ball, pair, SphereShape(radius), r)
        ball.setPositions([3 * place, 0, 0.5 + radius + drop])
        balls.append(ball)
    heights = []
    for _ in range(steps):
        world.step()
        heights.append([ball.getPositions()[2] - 0.5 - radius for ball in balls])
    return np.array(heights)


def box2d_2(r, step, drops, radius, steps):
    import Box2D

    world = Box2D.b2World(gravity=(0, -G))
    ground = Box2D.b2PolygonShape(box=(1000, 1, (0, -1), 0))
    world.CreateStaticBody(fixtures=Box2D.b2FixtureDef(shape=ground, restitution=0.0))
    circle = Box2D.b2CircleShape(radius=radius)
    fixture = Box2D.b2FixtureDef(shape=circle, density=1.0, restitution=r)
    balls = [
        world.CreateDynamicBody(position=(3 * place, radius + drop), fixtures=fixture)
        for place, drop in enumerate(drops)
    ]
    heights = []
    for _ in range(steps):
        world.Step(step, 8, 3)
        heights.append([ball.position.y - radius for ball in balls])
    return np.array(heights)


def rapier(r, step, drops, radius, steps):
    import rapier3d

    world = rapier3d.PhysicsWorld(gravity=(0, -G, 0))
    world.integration_parameters.dt = step
    ground = rapier3d.Collider.cuboid(1000, 1, 10).translation((0, -1, 0))
    world.add_collider(ground.restitution(r))
    balls = []
    for place, drop in enumerate(drops):
        ball = rapier3d.RigidBody.dynamic(translation=(3 * place, radius + drop, 0))
        shape = rapier3d.Collider.ball(radius).density(1.0).restitution(r)
        balls.append(world.add_body(ball, colliders=[shape]))
    heights = []
    for _ in range(steps):
        world.step()
        heights.append([world.rigid_bodies[ball].translation.y - radius for ball in balls])
    return np.array(heights)


def newton_xpbd(r, step, drops, radius, steps):
    import newton
    import warp

    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -G))
    material = newton.ModelBuilder.ShapeConfig(
        density=1000.0, mu=0.0, mu_torsional=0.0, mu_rolling=0.0, restitution=r
    )
    for place, drop in enumerate(drops):
        at = warp.transform(warp.vec3(3.0 * place, 0.0, radius + drop), warp.quat_identity())
        builder.add_shape_sphere(builder.add_body(xform=at), radius=radius, cfg=material)
    builder.add_ground_plane(cfg=material)
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverXPBD(model, enable_restitution=True)
    before = model.state()
    after = model.state()
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    heights = []
    for _ in range(steps):
        before.clear_forces()
        pipeline.collide(before, contacts)
        solver.step(before, after, model.control(), contacts, step)
        before, after = after, before
        heights.append(before.body_q.numpy()[:, 2].astype(float) - radius)
    return np.array(heights)


_MODEL = """<model name="{name}"><static>{is_static}</static><pose>{x!r} 0 {z!r} 0 0 0</pose>
<link name="link"><inertial><inertia><ixx>{inertia!r}</ixx><iyy>{inertia!r}</iyy>
<izz>{inertia!r}</izz></inertia></inertial><collision name="shape"><geometry>{shape}</geometry>
<surface><bounce><restitution_coefficient>{r!r}</restitution_coefficient></bounce></surface>
</collision></link></model>"""


def gazebo_sim(r, step, drops, radius, steps):
    """Gazebo's physics with DART, by the program engine_gz_sim.cpp."""
    program = shutil.which("engine_gz_sim")
    plugins = glob("/usr/lib/*/ign-physics-*/engine-plugins/*dartsim-plugin.so*")
    if program is None or not plugins:
        raise ModuleNotFoundError("engine_gz_sim", name="engine_gz_sim")
    box = "<box><size>1000 10 1</size></box>"
    models = [
        _MODEL.format(name="ground", is_static=True, x=0.0, z=-0.5, inertia=1.0, shape=box, r=1.0)
    ]
    ball = f"<sphere><radius>{radius!r}</radius></sphere>"
    for place, drop in enumerate(drops):
        at = dict(x=3.0 * place, z=float(radius + drop), inertia=0.4 * radius**2)
        models.append(_MODEL.format(name=f"ball{place}", is_static=False, shape=ball, r=r, **at))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "world.sdf")
        file.write_text(
            f"""<sdf version="1.6"><world name="drop"><gravity>0 0 {-G}</gravity>
            <physics name="dart" type="dart"><max_step_size>{step!r}</max_step_size></physics>
            {"".join(models)}</world></sdf>"""
        )
        command = [program, plugins[0], str(file), repr(step), str(steps)]
        ran = subprocess.run(command, capture_output=True, check=True, text=True)
    return np.loadtxt(ran.stdout.splitlines()) - radius


ENGINES = {
    "chipmunk": chipmunk,
    "dart": dart,
    "gazebo-sim": gazebo_sim,
    "box2d-2": box2d_2,
    "rapier": rapier,
    "newton-xpbd": newton_xpbd,
}


def rebound(heights):
    """Return the height of the first top after the impact; 0 if the ball does not fall again."""
    rising = np.flatnonzero(np.diff(heights) > 0)
    if not rising.size:
        return 0.0
    falling = np.flatnonzero(np.diff(heights[rising[0] + 1 :]) < 0)
    return max(heights[rising[0] + 1 + falling[0]], 0.0) if falling.size else 0.0


def dropped(run, r, step, drop, radius):
    """Return mean, least and greatest r of balls that meet the ground at instants within a step."""
    speed = math.sqrt(2 * G * drop)
    drops = drop + speed * step * (np.arange(INSTANTS) / INSTANTS - 0.5)
    heights = run(r, step, drops, radius, math.ceil(2.4 * speed / G / step) + 6)
    tops = [rebound(column) for column in heights.T]
    got = np.sqrt(np.array(tops) / drops)
    return got.mean(), got.min(), got.max()


def main():
    with FILE.open(newline="") as file:
        _, *lines = csv.reader(file)
    cases = dict.fromkeys(tuple(line[1:5]) for line in lines)
    for name in sys.argv[1:] or ENGINES:
        try:
            for case in cases:
                r, rate, drop, radius = map(float, case)
                found = dropped(ENGINES[name], r, 1 / rate, drop, radius)
                print(name, *case, *(f"{each:.4f}" for each in found), sep=",", flush=True)
        except ImportError as missing:
            print(f"{name}: {missing.name} is not installed", file=sys.stderr)


if __name__ == "__main__":
    main()
