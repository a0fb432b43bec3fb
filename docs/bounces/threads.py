"""Answers to ten threads on bouncing balls in engines: `threads.py NAME`, or all of them.

An answer that runs an engine is skipped where the engine is not installed.
"""

import math
import sys
from importlib.util import find_spec

from bouncing_ball import Contact, EngineSetup, describe_contact, write_contact
from bouncing_ball.models.damping import damping_ratio, restitution_coefficient

G = 9.81
MASS, STIFFNESS = 0.5, 1e5


def isaacsim_698():
    """A ball does bounce in Newton's MuJoCo solver: ke = k/m, kd = c/m."""
    found = write_contact(
        Contact(mass=MASS, stiffness=STIFFNESS, restitution=0.75),
        EngineSetup(engine="newton-mujoco"),
    )
    ke, kd = found.parameters["ke"], found.parameters["kd"]
    return f"ke = {ke:.6g}, kd = {kd:.4g}: r = {found.restitution:.4f}"


def newton_2009():
    """ke and kd of 1e5 N/m and 40.78 N s/m, as a MuJoCo solver with mass 0.5 kg reads them."""
    damping = 2 * float(damping_ratio(0.75)) * math.sqrt(STIFFNESS * MASS)
    parameters = {"ke": STIFFNESS, "kd": damping}
    of = {
        name: describe_contact(Contact(mass=MASS, from_engine=name, parameters=parameters))
        for name in ("newton-mujoco", "newton-semi-implicit")
    }
    return ", ".join(f"{name}: r = {x.measured_restitution:.4f}" for name, x in of.items())


def newton_2515():
    """kd for a restitution: the damping ratio of each release rule for r = 0.75."""
    return ", ".join(
        f"{rule}: zeta = {float(damping_ratio(0.75, rule)):.4f}"
        for rule in ("displacement", "force", "approach")
    )


def newton_1137():
    """Without restitution a penalty contact still bounces: the least r of ke and kd with ζ < 1."""
    least = float(restitution_coefficient(1 - 1e-9, "approach"))
    return f"damping on approach cannot stop a ball at zeta = 1: r = {least:.4f}"


def newton_1289():
    """XPBD: r is a number; one drop from 1 m at 1/240 s."""
    return _dropped("newton", 0.75)


def warp_948():
    """How to choose ke and kd: from r, and from how deep the ball of 0.5 kg may sink in."""
    # At 1 m/s the greatest penetration is about v √(m/k).
    depth = 2e-3
    contact = Contact(mass=MASS, stiffness=MASS / depth**2, restitution=0.75)
    found = write_contact(contact, EngineSetup(engine="newton-semi-implicit"))
    ke, kd = found.parameters["ke"], found.parameters["kd"]
    return f"ke = {ke:.6g} N/m, kd = {kd:.4g} N s/m, r = {found.restitution:.4f}"


def isaaclab_2890():
    """A ball with restitution 0.8 on a robot: the largest step for which k and c keep r to 1 %."""
    contact = Contact(mass=MASS, stiffness=STIFFNESS, restitution=0.8)
    found = write_contact(contact, EngineSetup(engine="newton-mujoco", restitution_error="1 %"))
    return f"{found.steps} steps in a contact: {found.time_step:.3g} s"


def rapier_974():
    """r² of drops from 2 m for r of 0.30, 0.50, 0.80, 0.95, and at 1/60 s in Chipmunk."""
    exact = ", ".join(f"{r * r:.2f}" for r in (0.3, 0.5, 0.8, 0.95))
    if find_spec("pymunk") is None:
        return f"h'/h = {exact}"
    got = ", ".join(f"{_chipmunk(r, 2.0, 1 / 60) ** 2:.2f}" for r in (0.3, 0.5, 0.8, 0.95))
    return f"h'/h = {exact}; Chipmunk {got}"


def box2d_1094():
    """Restitution from the speed of the step before: what gravity adds in a step, as a share."""
    speed = math.sqrt(2 * G * 1.0)
    return f"drop from 1 m at 1/60 s: g dt/v = {G / 60 / speed:.4f}"


def jolt_1286():
    """r = 1: the speed that a step of gravity adds at each bounce, from 1 m at 1/60 s."""
    gained = 1 + G / 60 / math.sqrt(2 * G)
    return f"h'/h = {gained**2:.4f} if the last step's gravity is added to the rebound"


def mujoco_3404():
    """Asked 0.75, got 0.820: -k and -c were given in place of -k/m and -c/m."""
    contact = Contact(mass=0.5, from_engine="mujoco", solref="-284244 -68.8", solimp="1e-4 1e-4")
    return f"r = {describe_contact(contact).measured_restitution:.4f}"


def _chipmunk(restitution, drop, step):
    import pymunk

    space = pymunk.Space()
    space.gravity = (0, -G)
    floor = pymunk.Segment(space.static_body, (-9, -1), (9, -1), 1)
    ball = pymunk.Body(1, 1)
    ball.position = (0, 0.1 + drop)
    circle = pymunk.Circle(ball, 0.1)
    floor.elasticity, circle.elasticity = 1.0, restitution
    space.add(floor, ball, circle)
    heights = []
    for _ in range(int(2.2 * math.sqrt(2 * drop / G) / step)):
        space.step(step)
        heights.append(ball.position.y - 0.1)
    rises = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
    return math.sqrt(max(heights[rises[0] :]) / drop)


def _dropped(engine, restitution):
    if find_spec(engine) is None:
        return f"skipped: {engine} is not installed"
    import newton
    import warp

    warp.config.quiet = True
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -G))
    material = newton.ModelBuilder.ShapeConfig(restitution=restitution)
    start = warp.transform(warp.vec3(0.0, 0.0, 1.1), warp.quat_identity())
    builder.add_shape_sphere(builder.add_body(xform=start), radius=0.1, cfg=material)
    builder.add_ground_plane(cfg=material)
    model = builder.finalize(device="cpu")
    solver = newton.solvers.SolverXPBD(model, enable_restitution=True)
    now = model.state()
    then = model.state()
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    heights = []
    for _ in range(230):
        now.clear_forces()
        pipeline.collide(now, contacts)
        solver.step(now, then, model.control(), contacts, 1 / 240)
        now, then = then, now
        heights.append(float(now.body_q.numpy()[0, 2]) - 0.1)
    rises = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
    return f"asked {restitution}, got {math.sqrt(max(heights[rises[0] :])):.3f}"


THREADS = {
    answer.__name__: answer
    for answer in (
        isaacsim_698, newton_2009, newton_1137, newton_1289, newton_2515, warp_948,
        isaaclab_2890, rapier_974, box2d_1094, jolt_1286, mujoco_3404,
    )
}  # fmt: skip

if __name__ == "__main__":
    for name in sys.argv[1:] or THREADS:
        print(f"{name:14}{THREADS[name]()}")
