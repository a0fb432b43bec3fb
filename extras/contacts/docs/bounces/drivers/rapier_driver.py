import rapier3d

world = rapier3d.PhysicsWorld(gravity=(0, -9.81, 0))
world.integration_parameters.dt = 1e-3
world.add_collider(rapier3d.Collider.cuboid(9, 0.1, 9).translation((0, -0.1, 0)).restitution(0.75))
shape = rapier3d.Collider.ball(0.1).restitution(0.75)
ball = world.add_body(rapier3d.RigidBody.dynamic(translation=(0, 1.1, 0)), colliders=[shape])
heights = [(world.step(), world.rigid_bodies[ball].translation.y - 0.1)[1] for _ in range(1100)]
