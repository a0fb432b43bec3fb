import newton
import warp

builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
cfg = newton.ModelBuilder.ShapeConfig(restitution=0.75, mu=0.0, mu_torsional=0.0, mu_rolling=0.0)
start = warp.transform(warp.vec3(0.0, 0.0, 1.1), warp.quat_identity())
builder.add_shape_sphere(builder.add_body(xform=start), radius=0.1, cfg=cfg)
builder.add_ground_plane(cfg=cfg)
model = builder.finalize(device="cpu")
solver = newton.solvers.SolverXPBD(model, enable_restitution=True)
states, pipeline = [model.state(), model.state()], newton.CollisionPipeline(model)
contacts, heights = pipeline.contacts(), []
for _ in range(1100):
    states[0].clear_forces(), pipeline.collide(states[0], contacts)
    solver.step(*states, model.control(), contacts, 1e-3)
    states.reverse(), heights.append(float(states[0].body_q.numpy()[0, 2]) - 0.1)
