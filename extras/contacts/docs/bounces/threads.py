"""Answers to threads on bouncing balls in engines: `threads.py NAME`, or all of them.

An answer that runs an engine is skipped where the engine is not installed.
"""

import math
import sys
from importlib.util import find_spec

from bouncing_ball_contacts import Bounce, design, diagnose

G = 9.81
MASS, STIFFNESS = 0.5, 1e5
# In such steps a contact of these stiffnesses has its limit to four digits.
SHORT = 2e-7


def restitution(ratio, rule):
    """Return r of a damping ratio below 1 under a release rule."""
    root = math.sqrt(1 - ratio * ratio)
    if rule == "displacement":
        return math.exp(-math.pi * ratio / root)
    force = math.exp(-ratio * (math.pi - 2 * math.asin(ratio)) / root)
    return math.sqrt(force) if rule == "approach" else force


def damping_ratio(r, rule="displacement"):
    """Return the damping ratio of r under a release rule, by bisection."""
    low, high = 0.0, 1 - 1e-12
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if restitution(middle, rule) > r else (low, middle)
    return low


def free(engine, parameters, mass, step=SHORT):
    """Return r without gravity in short steps of an engine's parameters."""
    return diagnose(Bounce(mass=mass, speed=1.0, radius=1.0), engine, parameters, step).free


def rise(engine, parameters, step=1e-6):
    """Return the height in m to which 1 kg rises that is dropped from 1 m."""
    bounce = Bounce(mass=1.0, drop_height=1.0, radius=1.0, gravity=G)
    return diagnose(bounce, engine, parameters, step).limit ** 2


def isaacsim_698():
    """A ball does bounce in Newton's MuJoCo solver: ke = k/m, kd = c/m."""
    bounce = Bounce(mass=MASS, restitution=0.75, stiffness=STIFFNESS, speed=2.0)
    found = design(bounce, "newton-mujoco", tolerance=0.002)
    ke = found.parameters["ke"]
    kd = found.parameters["kd"]
    return f"ke = {ke:.6g}, kd = {kd:.4g}: r = {free('newton-mujoco', found.parameters, MASS):.3f}"


def newton_2009():
    """ke and kd of 1e5 N/m and 40.78 N s/m, as a MuJoCo solver with mass 0.5 kg reads them."""
    damping = 2 * damping_ratio(0.75) * math.sqrt(STIFFNESS * MASS)
    parameters = {"ke": STIFFNESS, "kd": damping}
    names = ("newton-mujoco", "newton")
    return ", ".join(f"{name}: r = {free(name, parameters, MASS):.3f}" for name in names)


def newton_2515():
    """kd for a restitution: the damping ratio of each release rule for r = 0.75."""
    rules = ("displacement", "force", "approach")
    return ", ".join(f"{rule}: zeta = {damping_ratio(0.75, rule):.4f}" for rule in rules)


def newton_1137():
    """Without restitution a penalty contact still bounces: r at a damping ratio of 1."""
    least = restitution(1 - 1e-9, "approach")
    return f"damping on approach cannot stop a ball at zeta = 1: r = {least:.4f}"


def newton_1289():
    """XPBD: r is a number; one drop from 1 m at 1/240 s."""
    return _dropped("newton", 0.75)


def warp_948():
    """How to choose ke and kd: from r, and from how deep the ball of 0.5 kg may sink in."""
    bounce = Bounce(mass=MASS, restitution=0.75, penetration="2 mm", speed=1.0, radius=0.1)
    found = design(bounce, "newton")
    ke = found.parameters["ke"]
    kd = found.parameters["kd"]
    r = found.row.outcome.around
    return f"ke = {ke:.4g} N/m, kd = {kd:.4g} N s/m at {found.row.step:.3g} s: {r}"


def isaaclab_2890():
    """A ball with restitution 0.8 on a robot: the step that k and c need for r to 1 %."""
    bounce = Bounce(mass=MASS, restitution=0.8, stiffness=STIFFNESS)
    found = design(bounce, "newton-mujoco", tolerance=0.02)
    return f"{found.row.step:.3g} s: {found.row.outcome.around}"


def isaaclab_6789():
    """What Newton's defaults are where they cannot be set: ke = 2500 and kd = 100."""
    return f"newton-mujoco: r = {free('newton-mujoco', {'ke': 2500.0, 'kd': 100.0}, 1.0, 1e-5):.3f}"


def rapier_974():
    """The test of the thread: r² of drops from 2 m at 1/60 s, and in Chipmunk and Rapier."""
    asked = (0.3, 0.5, 0.8, 0.95)
    answer = ["h'/h = " + ", ".join(f"{r * r:.2f}" for r in asked)]
    for name, module, drop in (("Chipmunk", "pymunk", _chipmunk), ("Rapier", "rapier3d", _rapier)):
        if find_spec(module) is not None:
            got = ", ".join(f"{drop(r, 2.0, 1 / 60) ** 2:.2f}" for r in asked)
            answer.append(f"{name} {got}")
    return "; ".join(answer)


def rapier_919():
    """Whether a ball with r = 0.8 bounces if contacts are predicted at a greater distance."""
    if find_spec("rapier3d") is None:
        return "skipped: rapier3d is not installed"
    got = ", ".join(f"{x}: {_rapier(0.8, 2.0, 1 / 60, x):.3f}" for x in (0.02, 0.1))
    return f"r by normalized_prediction_distance: {got}"


def bullet_3094():
    """The speed below which Bullet's restitution is 0 by default, as the height of a drop."""
    return f"drops below {0.2**2 / (2 * G):.4f} m do not bounce"


def physx_351():
    """The speed below which PhysX's restitution is 0 by default, as the height of a drop."""
    return f"drops below {2.0**2 / (2 * G):.4f} m do not bounce"


def lammps_4068():
    """`damping coeff_restitution` holds for a contact whose damper may pull."""
    released = restitution(damping_ratio(0.75), "force")
    return f"asked 0.75: r = 0.7500, with limit_damping {released:.4f}"


def lammps_5110():
    """A number for a test of `hooke`: kn = 1e4 N/m, gamma_n = 20/s, 1 kg, dropped from 1 m."""
    parameters = {"kn": 1e4, "gamma_n": 20.0}
    return f"r = {free('lammps', parameters, 1.0):.3f}, rises to {rise('lammps', parameters):.3f} m"


def drake_24063():
    """A plant without a time step, k = 1e4 N/m and dissipation 0.1 s/m, dropped from 1 m."""
    parameters = {"point_contact_stiffness": 2e4, "hunt_crossley_dissipation": 0.1}
    answer = f"rises to {rise('drake-hunt-crossley', parameters):.3f} m"
    if find_spec("pydrake") is None:
        return answer
    schemes = (("cenic", 1e-3), ("cenic", 1e-5), ("runge_kutta3", 1e-3))
    got = ", ".join(
        f"{name} {accuracy:g}: {_drake(name, accuracy):.3f}" for name, accuracy in schemes
    )
    return f"{answer}; {got}"


def chrono_634():
    """The default restitution 0.4, which the documentation gave as 0."""
    zeta = ", ".join(f"{damping_ratio(0.4, rule):.4f}" for rule in ("displacement", "force"))
    return f"h'/h = {0.4**2:.2f}, not 0; zeta = {zeta}"


def openhfdib_18():
    """r of a sphere on a wall, for an overlap that is small: the damping is that of Hertz' contact,
    and the force that of the overlap's volume, which grows as its square.
    """
    asked = (0.9, 0.75, 0.5)
    ratios = [math.sqrt(5 / 6) * damping_ratio(r) for r in asked]
    got = ", ".join(f"{restitution(ratio, 'force'):.3f}" for ratio in ratios)
    return f"asked {', '.join(map(str, asked))}: r = {got}"


def farms_21():
    """k and b of `solref` are in 1/s² and 1/s: the mass does not matter."""
    of = [free("mujoco", {"solref": "-284244 -68.8"}, mass) for mass in (0.5, 5.0)]
    return ", ".join(f"r = {r:.3f}" for r in of)


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
    parameters = {"solref": "-284244 -68.8", "solimp": "1e-4 1e-4"}
    return f"r = {free('mujoco', parameters, 0.5):.3f}"


def _chipmunk(restitution, drop, step):
    import pymunk

    space = pymunk.Space()
    space.gravity = (0, -G)
    floor = pymunk.Segment(space.static_body, (-9, -1), (9, -1), 1)
    ball = pymunk.Body(1, 1)
    ball.position = (0, 0.1 + drop)
    circle = pymunk.Circle(ball, 0.1)
    floor.elasticity = 1.0
    circle.elasticity = restitution
    space.add(floor, ball, circle)
    heights = []
    for _ in range(int(2.2 * math.sqrt(2 * drop / G) / step)):
        space.step(step)
        heights.append(ball.position.y - 0.1)
    rises = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
    return math.sqrt(max(heights[rises[0] :]) / drop)


def _rapier(restitution, drop, step, prediction=0.02):
    import rapier3d

    world = rapier3d.PhysicsWorld(gravity=(0, -G, 0))
    world.integration_parameters.dt = step
    world.integration_parameters.normalized_prediction_distance = prediction
    world.add_collider(rapier3d.Collider.cuboid(30, 0.1, 30).restitution(restitution))
    shape = rapier3d.Collider.ball(0.2).density(1.0).restitution(restitution)
    start = rapier3d.RigidBody.dynamic(translation=(0, 0.3 + drop, 0))
    ball = world.add_body(start, colliders=[shape])
    heights = []
    for _ in range(int(2.2 * math.sqrt(2 * drop / G) / step)):
        world.step()
        heights.append(world.rigid_bodies[ball].translation.y - 0.3)
    rises = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
    return math.sqrt(max(heights[rises[0] :]) / drop)


def _drake(scheme, accuracy):
    from pydrake import all as drake

    builder = drake.DiagramBuilder()
    config = drake.MultibodyPlantConfig(time_step=0.0, contact_model="point")
    plant, _ = drake.AddMultibodyPlant(config, builder)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -G])
    ball = plant.AddRigidBody("ball", drake.SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    properties = drake.ProximityProperties()
    drake.AddContactMaterial(
        dissipation=0.1,
        point_stiffness=2e4,
        friction=drake.CoulombFriction(),
        properties=properties,
    )
    still = drake.RigidTransform()
    for body, shape in ((plant.world_body(), drake.HalfSpace()), (ball, drake.Sphere(0.1))):
        plant.RegisterCollisionGeometry(body, still, shape, body.name(), properties)
    plant.Finalize()
    plant.SetDefaultFloatingBaseBodyPose(ball, drake.RigidTransform([0, 0, 1.1]))
    log = drake.LogVectorOutput(plant.get_state_output_port(), builder, 1e-3)
    simulator = drake.Simulator(builder.Build())
    settings = drake.SimulatorConfig(
        integration_scheme=scheme, accuracy=accuracy, use_error_control=True
    )
    drake.ApplySimulatorConfig(settings, simulator)
    simulator.AdvanceTo(1.1)
    heights = log.FindLog(simulator.get_context()).data()[6] - 0.1
    rises = [k for k in range(1, len(heights)) if heights[k] > heights[k - 1]]
    return max(heights[rises[0] :])


def _dropped(engine, restitution):
    if find_spec(engine) is None:
        return f"skipped: {engine} is not installed"
    import newton
    import warp

    warp.config.log_level = warp.LOG_WARNING
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
        isaaclab_2890, isaaclab_6789, rapier_974, rapier_919, box2d_1094, jolt_1286,
        bullet_3094, physx_351, mujoco_3404, farms_21, lammps_4068, lammps_5110, drake_24063,
        chrono_634, openhfdib_18,
    )
}  # fmt: skip

if __name__ == "__main__":
    for name in sys.argv[1:] or THREADS:
        print(f"{name:14}{THREADS[name]()}")
