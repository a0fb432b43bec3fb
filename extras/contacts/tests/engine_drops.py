"""Balls that are dropped in engines whose restitution is a number, with text as it is pasted.

``python tests/engine_drops.py [ENGINE]...`` prints the lines of engine_drops.csv of the engines
that are installed, measured again. Those of JavaScript are run by ``engine_drops.mjs``, which has
the command that installs them.

An engine takes a text, the heights of drops and a radius in m, the number of steps and the kind of
body, and returns the heights of the bodies over the surface, of the shape (steps, drop). The last
line of a text is run in each step, and the others once for each body. What they do not set is left
to the engine.
"""

import csv
import functools
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
from glob import glob
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from engine_runs import as_python, quiet_warp, rebound

from bouncing_ball_contacts.rows import BY_NUMBER

G = 9.81
INSTANTS = 8
FILE = Path(__file__).with_suffix(".csv")


class Body(NamedTuple):
    """A "ball", a flat "box" or a lying "capsule" with four radii between its centres.

    ``spin`` is an angular velocity in rad/s about a horizontal axis, and ``mass`` is in kg.
    """

    shape: str = "ball"
    spin: float = 0.0
    mass: float = 1.0


BALL = Body()


def apart(radius):
    """Return the distance of balls in m, so that large ones do not touch each other."""
    return max(3.0, 3 * radius)


def lines_of(text):
    """Return the code that sets the parameters, and the code of a step."""
    *sets, steps = as_python(text)
    return compile("\n".join(sets), "snippet", "exec"), compile(steps, "snippet", "exec")


def chipmunk(text, drops, radius, steps, kind=BALL):
    import pymunk

    sets, advances = lines_of(text)

    space = pymunk.Space()
    space.gravity = (0, -G)
    floor = pymunk.Segment(space.static_body, (-1000, -1), (1000, -1), 1)
    exec(sets, {"shape": floor})
    space.add(floor)
    side = 2 * radius
    shapes = {
        "ball": lambda body: pymunk.Circle(body, radius),
        "box": lambda body: pymunk.Poly.create_box(body, (side, side)),
        "capsule": lambda body: pymunk.Segment(body, (-side, 0), (side, 0), radius),
    }
    balls = []
    for place, drop in enumerate(drops):
        body = pymunk.Body()
        body.position = (apart(radius) * place, radius + drop)
        body.angular_velocity = kind.spin
        shape = shapes[kind.shape](body)
        shape.mass = kind.mass
        exec(sets, {"shape": shape})
        space.add(body, shape)
        balls.append(body)
    heights = []
    for _ in range(steps):
        exec(advances, {"space": space})
        heights.append([ball.position.y - radius for ball in balls])
    return np.array(heights)


def dart(text, drops, radius, steps, kind=BALL):
    from dartpy.collision import OdeCollisionDetector
    from dartpy.dynamics import BoxShape, CapsuleShape, Inertia, Skeleton, SphereShape
    from dartpy.simulation import World

    sets, advances = lines_of(text)
    world = World("bounce")
    world.setGravity([0, 0, -G])
    # The step is set, and not an argument of it.
    exec(advances, {"world": world})
    if kind.shape == "capsule":
        # The default detector makes a ball of a capsule, with a message.
        world.getConstraintSolver().setCollisionDetector(OdeCollisionDetector())

    def add(skeleton, pair, shape, mass=1.0):
        node = pair[1].createShapeNode(shape)
        node.createCollisionAspect()
        node.createDynamicsAspect()
        exec(sets, {"dynamicsAspect": node.getDynamicsAspect()})
        pair[1].setInertia(Inertia(mass, [0, 0, 0], shape.computeInertia(mass)))
        world.addSkeleton(skeleton)

    shapes = {
        "ball": lambda: SphereShape(radius),
        "box": lambda: BoxShape([2 * radius] * 3),
        "capsule": lambda: CapsuleShape(radius, 4 * radius),
    }
    ground = Skeleton("ground")
    add(ground, ground.createWeldJointAndBodyNodePair(), BoxShape([1000, 10, 1]))
    balls = []
    for place, drop in enumerate(drops):
        ball = Skeleton(f"ball {place}")
        add(ball, ball.createFreeJointAndBodyNodePair(), shapes[kind.shape](), kind.mass)
        # The axis of a capsule is z, and its quarter turn is about x.
        turn = math.pi / 2 if kind.shape == "capsule" else 0.0
        ball.setPositions([turn, 0, 0, apart(radius) * place, 0, 0.5 + radius + drop])
        ball.setVelocities([0, kind.spin, 0, 0, 0, 0])
        balls.append(ball)
    heights = []
    for _ in range(steps):
        world.step()
        heights.append([ball.getPositions()[5] - 0.5 - radius for ball in balls])
    return np.array(heights)


def box2d_2(text, drops, radius, steps, kind=BALL):
    import Box2D

    sets, advances = lines_of(text)
    world = Box2D.b2World(gravity=(0, -G))
    ground = Box2D.b2PolygonShape(box=(1000, 1, (0, -1), 0))
    world.CreateStaticBody(fixtures=Box2D.b2FixtureDef(shape=ground))
    shapes = {
        "ball": lambda: Box2D.b2CircleShape(radius=radius),
        "box": lambda: Box2D.b2PolygonShape(box=(radius, radius)),
    }
    area = {"ball": math.pi, "box": 4.0}[kind.shape] * radius**2
    fixture = Box2D.b2FixtureDef(shape=shapes[kind.shape](), density=kind.mass / area)
    exec(sets, {"fixtureDef": fixture})
    balls = [
        world.CreateDynamicBody(
            position=(apart(radius) * place, radius + drop),
            angularVelocity=kind.spin,
            fixtures=fixture,
        )
        for place, drop in enumerate(drops)
    ]
    heights = []
    for _ in range(steps):
        exec(advances, {"world": world})
        heights.append([ball.position.y - radius for ball in balls])
    return np.array(heights)


def rapier(text, drops, radius, steps, kind=BALL):
    import rapier3d

    sets, advances = as_python(text)

    def of(shape):
        return eval(sets, {"ColliderBuilder": SimpleNamespace(ball=lambda _: shape), "radius": 0})

    world = rapier3d.PhysicsWorld(gravity=(0, -G, 0))
    exec(advances, {"integration_parameters": world.integration_parameters})
    ground = rapier3d.Collider.cuboid(1000, 1, 10).translation((0, -1, 0))
    world.add_collider(of(ground))
    shapes = {
        "ball": lambda: rapier3d.Collider.ball(radius),
        "box": lambda: rapier3d.Collider.cuboid(radius, radius, radius),
        "capsule": lambda: rapier3d.Collider.capsule_z(2 * radius, radius),
    }
    balls = []
    for place, drop in enumerate(drops):
        ball = rapier3d.RigidBody.dynamic(
            translation=(apart(radius) * place, radius + drop, 0), angvel=(0, 0, kind.spin)
        )
        shape = of(shapes[kind.shape]().mass(kind.mass))
        balls.append(world.add_body(ball, colliders=[shape]))
    heights = []
    for _ in range(steps):
        world.step()
        heights.append([world.rigid_bodies[ball].translation.y - radius for ball in balls])
    return np.array(heights)


def newton_xpbd(text, drops, radius, steps, kind=BALL):
    warp = quiet_warp()
    import newton

    sets, advances = as_python(text)
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -G))
    material = eval(sets, {"ShapeConfig": newton.ModelBuilder.ShapeConfig})
    # Volumes in units of the cubed radius.
    volume = {"ball": 4 / 3 * math.pi, "box": 8.0, "capsule": 16 / 3 * math.pi}[kind.shape]
    material.density = kind.mass / (volume * radius**3)
    half = math.sqrt(0.5)
    turned = warp.quat(half, 0.0, 0.0, half) if kind.shape == "capsule" else warp.quat_identity()
    for place, drop in enumerate(drops):
        at = warp.transform(warp.vec3(apart(radius) * place, 0.0, radius + drop), turned)
        body = builder.add_body(xform=at)
        if kind.shape == "box":
            builder.add_shape_box(body, hx=radius, hy=radius, hz=radius, cfg=material)
        elif kind.shape == "capsule":
            builder.add_shape_capsule(body, radius=radius, half_height=2 * radius, cfg=material)
        else:
            builder.add_shape_sphere(body, radius=radius, cfg=material)
    builder.add_ground_plane(cfg=material)
    model = builder.finalize(device="cpu")
    model.joint_qd.assign([0, 0, 0, 0, kind.spin, 0] * len(drops))
    solver = newton.solvers.SolverXPBD(model, enable_restitution=True)
    before = model.state()
    after = model.state()
    newton.eval_fk(model, model.joint_q, model.joint_qd, before)
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    names = dict(solver=solver, control=model.control(), contacts=contacts)
    heights = []
    for _ in range(steps):
        before.clear_forces()
        pipeline.collide(before, contacts)
        exec(advances, {**names, "state": before, "following": after})
        before, after = after, before
        heights.append(before.body_q.numpy()[:, 2].astype(float) - radius)
    return np.array(heights)


_MODEL = """<model name="{name}"><static>{is_static}</static><pose>{x!r} 0 {z!r} 0 0 0</pose>
<link name="link"><inertial><mass>{mass!r}</mass><inertia><ixx>{inertia!r}</ixx>
<iyy>{inertia!r}</iyy><izz>{inertia!r}</izz></inertia></inertial>
<collision name="shape"><geometry>{shape}</geometry>
<surface><bounce>{bounce}</bounce></surface></collision></link></model>"""


def gazebo_sim(text, drops, radius, steps, kind=BALL):
    """Gazebo's physics with DART, by the program engine_gz_sim.cpp."""
    program = shutil.which("engine_gz_sim")
    plugins = glob("/usr/lib/*/ign-physics-*/engine-plugins/*dartsim-plugin.so*")
    if program is None or not plugins:
        raise ModuleNotFoundError("engine_gz_sim", name="engine_gz_sim")
    bounce, physics = text.splitlines()
    (step,) = re.findall("<max_step_size>(.*)</max_step_size>", physics)
    box = "<box><size>1000 10 1</size></box>"
    models = [
        _MODEL.format(
            name="ground",
            is_static=True,
            x=0.0,
            z=-0.5,
            mass=1.0,
            inertia=1.0,
            shape=box,
            bounce=bounce,
        )
    ]
    ball = f"<sphere><radius>{radius!r}</radius></sphere>"
    for place, drop in enumerate(drops):
        at = dict(
            x=apart(radius) * place, z=float(radius + drop), name=f"ball{place}", is_static=False
        )
        of = dict(mass=kind.mass, inertia=0.4 * kind.mass * radius**2, shape=ball, bounce=bounce)
        models.append(_MODEL.format(**at, **of))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "world.sdf")
        file.write_text(
            f"""<sdf version="1.6"><world name="drop"><gravity>0 0 {-G}</gravity>
            <physics type="ode">{physics}</physics>
            {"".join(models)}</world></sdf>"""
        )
        command = [program, plugins[0], str(file), step, str(steps)]
        ran = subprocess.run(command, capture_output=True, check=True, text=True)
    return np.loadtxt(ran.stdout.splitlines()) - radius


def by_node(name, text, drops, radius, steps, kind=BALL, **more):
    """Return the heights in an engine of JavaScript; `more` is what another adapter needs."""
    node = shutil.which("node")
    if node is None:
        raise ModuleNotFoundError("Node.js", name="Node.js")
    drop = dict(engine=name, text=text, radius=radius, steps=steps, **kind._asdict(), **more)
    jobs = json.dumps([{**drop, "drop": float(height)} for height in drops])
    # Node.js looks for packages beside a program: here in the working folder.
    with tempfile.NamedTemporaryFile(suffix=".mjs", dir=".") as program:
        program.write(FILE.with_suffix(".mjs").read_bytes())
        program.flush()
        command = [node, program.name]
        ran = subprocess.run(command, input=jobs, capture_output=True, text=True)
    if ran.returncode == NOT_INSTALLED:
        raise ModuleNotFoundError(ran.stderr.strip(), name=ran.stderr.strip())
    if ran.returncode:
        raise RuntimeError(ran.stderr)
    return np.array(json.loads(ran.stdout.splitlines()[-1])).T


NOT_INSTALLED = 3
"""Exit status of engine_drops.mjs without the package of an engine."""
OF_NODE = ("jolt", "physx", "box2d-3.1", "box2d-2", "planck", "matter-js", "cannon-es")
ENGINES = {
    "chipmunk": chipmunk,
    "dart": dart,
    "gazebo-sim": gazebo_sim,
    "box2d-2.3": box2d_2,
    "rapier": rapier,
    "newton-xpbd": newton_xpbd,
    **{name: functools.partial(by_node, name) for name in OF_NODE},
}
STANDS_FOR = {
    "unity": dict(offset=0.01),
    "isaac-lab": dict(offset=1.0, threshold=0.5),
    # PhysX has no threshold of 0; every impact here is faster than this one.
    "isaac-sim": dict(offset=1.0, threshold=0.2),
}
"""The contact offset in m and the threshold in m/s with which PhysX is run for other rows."""


def text_of(name, r, step, threshold=None):
    """Return the lines of an engine for r of both bodies, without damping."""
    row = BY_NUMBER[name]
    values = {row.parameter: row.pair.alike(r), row.damped_by: 0.0, "step": step}
    if threshold is not None:
        values[row.set_by] = threshold
    return "\n".join(
        line.format(name=key, value=repr(values[key]), bodies="both bodies", rate=1 / step)
        for key, line in row.lines.items()
        if key in values
    )


def dropped(run, text, step, drop, radius):
    """Return mean, least and greatest r of balls that meet the ground at instants within a step.

    ``run`` is an engine, and ``step`` is that of the text.
    """
    speed = math.sqrt(2 * G * drop)
    drops = drop + speed * step * (np.arange(INSTANTS) / INSTANTS - 0.5)
    heights = run(text, drops, radius, math.ceil(2.4 * speed / G / step) + 6)
    tops = [rebound(column) for column in heights.T]
    got = np.sqrt(np.array(tops) / drops)
    return got.mean(), got.min(), got.max()


def main():
    with FILE.open(newline="") as file:
        _, *lines = csv.reader(file)
    cases = dict.fromkeys(tuple(line[1:5]) for line in lines)
    for name in sys.argv[1:] or [*ENGINES, *STANDS_FOR]:
        more = dict(STANDS_FOR.get(name, {}))
        threshold = more.pop("threshold", None)
        of = "physx" if more else name
        try:
            for case in cases:
                r, rate, drop, radius = map(float, case)
                run = functools.partial(ENGINES[of], **more)
                text = text_of(of, r, 1 / rate, threshold)
                restitutions = dropped(run, text, 1 / rate, drop, radius)
                print(
                    name,
                    *case,
                    *(f"{restitution:.4f}" for restitution in restitutions),
                    sep=",",
                    flush=True,
                )
        except ImportError as missing:
            print(f"{name}: {missing.name} is not installed", file=sys.stderr)


if __name__ == "__main__":
    main()
