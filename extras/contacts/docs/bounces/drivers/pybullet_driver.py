import pybullet

pybullet.connect(pybullet.DIRECT)
pybullet.setGravity(0, 0, -9.81)
pybullet.setPhysicsEngineParameter(fixedTimeStep=1 / 240, numSubSteps=1)
plane = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.1)
ball = pybullet.createMultiBody(1, sphere, basePosition=[0, 0, 1.1])
for body, r in ((plane, 1.0), (ball, 0.75)):
    pybullet.changeDynamics(body, -1, restitution=r, linearDamping=0)
place = pybullet.getBasePositionAndOrientation
heights = [(pybullet.stepSimulation(), place(ball)[0][2] - 0.1)[1] for _ in range(264)]
