import newton
import warp

builder = newton.ModelBuilder(gravity=(0.0, 0.0, -9.81))
cfg = newton.ModelBuilder.ShapeConfig(density=238.7324146, ke=1e4, kd=20.0, kf=0.0, mu=0.0)
start = warp.transform(warp.vec3(0.0, 0.0, 1.1), warp.quat_identity())
builder.add_shape_sphere(builder.add_body(xform=start), radius=0.1, cfg=cfg)
builder.add_ground_plane(cfg=cfg)
model = builder.finalize(device="cpu")
solver, pipeline = newton.solvers.SolverSemiImplicit(model), newton.CollisionPipeline(model)
states, contacts, heights = [model.state(), model.state()], pipeline.contacts(), []
for _ in range(5500):
    states[0].clear_forces(), pipeline.collide(states[0], contacts)
    solver.step(*states, model.control(), contacts, 2e-4)
    states.reverse(), heights.append(float(states[0].body_q.numpy()[0, 2]) - 0.1)
