"""A ball over a table in Newton, MuJoCo Warp and Genesis, as the texts of the recipes are pasted.

Newton and MuJoCo Warp compute with single precision, so that velocities are read from the engine:
differences of heights would lose their digits. Each engine returns heights and velocities of the
ball after each step.
"""

import math

import numpy as np

RADIUS = 0.05


def newton(trial):
    import newton
    import warp

    warp.config.quiet = True
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -trial.gravity))
    names = {"newton": newton, "builder": builder}
    exec(trial.settings.snippet, names)
    material = names["material"]
    material.density = 0.0
    attributes = names.get("attributes", {})
    inertia = 0.4 * trial.mass * RADIUS**2
    ball = builder.add_body(
        mass=trial.mass,
        inertia=warp.mat33(inertia * np.eye(3)),
        xform=warp.transform(warp.vec3(0, 0, RADIUS + trial.height), warp.quat_identity()),
    )
    builder.add_shape_sphere(ball, radius=RADIUS, cfg=material, custom_attributes=attributes)
    builder.add_shape_plane(
        body=-1, width=0.0, length=0.0, cfg=material, custom_attributes=attributes
    )
    model = builder.finalize(device="cpu")
    speed = np.array([0, 0, trial.speed, 0, 0, 0])
    model.joint_qd.assign(speed)
    model.body_qd.assign(speed[None])
    solver = names["solver_type"](model)
    before, after = model.state(), model.state()
    newton.eval_fk(model, model.joint_q, model.joint_qd, before)
    # SolverMuJoCo finds the contacts itself.
    finds = names["solver_type"] is not newton.solvers.SolverMuJoCo
    pipeline = newton.CollisionPipeline(model) if finds else None
    contacts = pipeline.contacts() if finds else None
    heights, speeds = [], []
    for _ in range(trial.steps):
        before.clear_forces()
        if finds:
            pipeline.collide(before, contacts)
        solver.step(before, after, model.control(), contacts, names["time_step"])
        before, after = after, before
        heights.append(float(before.body_q.numpy()[0, 2]) - RADIUS)
        speeds.append(float(before.body_qd.numpy()[0, 2]))
    return np.array(heights), np.array(speeds)


def mujoco_warp(trial):
    """The text of the recipe for MuJoCo, which MuJoCo Warp reads from the compiled model."""
    import mujoco
    import mujoco_warp
    import warp

    warp.config.quiet = True
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
{trial.settings.snippet}
<option gravity="0 0 {-trial.gravity!r}"/>
<worldbody>
  <geom class="bounce" type="plane" size="1 1 1"/>
  <body pos="0 0 {RADIUS}">
    <joint type="slide" axis="0 0 1"/>
    <geom class="bounce" type="sphere" size="{RADIUS}" mass="{trial.mass!r}"/>
  </body>
</worldbody>
</mujoco>""")
    data = mujoco.MjData(model)
    data.qpos[0] = trial.height
    data.qvel[0] = trial.speed
    mujoco.mj_forward(model, data)
    there = mujoco_warp.put_model(model)
    state = mujoco_warp.put_data(model, data)
    heights, speeds = [], []
    for _ in range(trial.steps):
        mujoco_warp.step(there, state)
        heights.append(float(state.qpos.numpy()[0, 0]))
        speeds.append(float(state.qvel.numpy()[0, 0]))
    return np.array(heights), np.array(speeds)


def genesis_balls(trials, radius=RADIUS):
    """Trials that differ in their heights only, as environments of one scene: (steps, trial).

    A ball that sinks in deeper than its radius falls through Genesis' plane.
    """
    import genesis as gs

    if not gs._initialized:
        gs.init(backend=gs.cpu, precision="64", logging_level="error")
    one = trials[0]
    names = {"gs": gs}
    first, rest = one.settings.snippet.split("\n", 1)
    exec(first, names)
    options = names["options"]
    options.gravity = (0.0, 0.0, -one.gravity)
    scene = gs.Scene(show_viewer=False, sim_options=options)
    volume = 4 / 3 * math.pi * radius**3
    table = scene.add_entity(gs.morphs.Plane())
    ball = scene.add_entity(
        gs.morphs.Sphere(radius=radius, pos=(0.0, 0.0, 2 * radius)),
        material=gs.materials.Rigid(rho=one.mass / volume, friction=0.01),
    )
    scene.build(n_envs=len(trials))
    exec(rest, {"ball": ball, "table": table})
    ball.set_pos(np.array([(0.0, 0.0, radius + trial.height) for trial in trials]))
    ball.set_dofs_velocity(np.array([(0.0, 0.0, trial.speed, 0.0, 0.0, 0.0) for trial in trials]))
    heights, speeds = [], []
    for _ in range(one.steps):
        scene.step()
        heights.append(ball.get_pos().numpy()[:, 2] - radius)
        speeds.append(ball.get_dofs_velocity().numpy()[:, 2])
    return np.array(heights), np.array(speeds)


def genesis(trial):
    heights, speeds = genesis_balls([trial])
    return heights[:, 0], speeds[:, 0]


NEWER = {
    "newton-semi-implicit": newton,
    "newton-mujoco": newton,
    "mujoco-warp": mujoco_warp,
    "genesis": genesis,
}
RECIPES = {"mujoco-warp": "mujoco"}
"""The recipes of engines that have none of their own."""
