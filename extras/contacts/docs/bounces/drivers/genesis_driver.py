import genesis

genesis.init(backend=genesis.cpu, precision="64", logging_level="error")
options = genesis.options.SimOptions(dt=1e-4, substeps=1, gravity=(0.0, 0.0, -9.81))
scene = genesis.Scene(show_viewer=False, sim_options=options)
plane = scene.add_entity(genesis.morphs.Plane())
sphere = genesis.morphs.Sphere(radius=0.1, pos=(0.0, 0.0, 1.1))
ball = scene.add_entity(sphere, material=genesis.materials.Rigid(rho=238.7324146))
scene.build()
for geom in (*ball.geoms, *plane.geoms):
    geom.set_sol_params((2 / 20, 20 / (4 * 1e4) ** 0.5, 1e-4, 1e-4, 0.001, 0.5, 2.0))
heights = [(scene.step(), float(ball.get_pos()[2]) - 0.1)[1] for _ in range(11_000)]
