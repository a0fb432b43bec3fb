import newton
import warp

builder, MuJoCo = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81)), newton.solvers.SolverMuJoCo
MuJoCo.register_custom_attributes(builder)
cfg = newton.ModelBuilder.ShapeConfig(density=238.7324146, ke=1e4, kd=20.0)
own = {"mujoco:condim": 1, "mujoco:geom_solimp": (1e-4, 1e-4, 0.001, 0.5, 2.0)}
start = warp.transform(warp.vec3(0.0, 0.0, 1.1), warp.quat_identity())
ball = builder.add_body(xform=start)
builder.add_shape_sphere(ball, radius=0.1, cfg=cfg, custom_attributes=own)
builder.add_shape_plane(body=-1, width=0.0, length=0.0, cfg=cfg, custom_attributes=own)
model = builder.finalize(device="cpu")
solver, states, heights = MuJoCo(model), [model.state(), model.state()], []
for _ in range(2200):
    solver.step(*states, model.control(), None, 5e-4)
    states.reverse(), heights.append(float(states[0].body_q.numpy()[0, 2]) - 0.1)
