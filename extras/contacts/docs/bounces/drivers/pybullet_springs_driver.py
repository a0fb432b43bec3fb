import pybullet

pybullet.connect(pybullet.DIRECT)
pybullet.setGravity(0, 0, -9.81)
pybullet.setPhysicsEngineParameter(fixedTimeStep=1e-5, numSubSteps=1, contactSlop=0)
plane = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.1)
ball = pybullet.createMultiBody(1, sphere, basePosition=[0, 0, 1.1])
k, c = 2 * 1e4, (20 - 1e-5 * 1e4) / 2
spring = {"contactStiffness": k, "contactDamping": c, "contactProcessingThreshold": 0}
for body in (plane, ball):
    pybullet.changeDynamics(body, -1, **spring, linearDamping=0)
place = pybullet.getBasePositionAndOrientation
heights = [(pybullet.stepSimulation(), place(ball)[0][2] - 0.1)[1] for _ in range(110_000)]
