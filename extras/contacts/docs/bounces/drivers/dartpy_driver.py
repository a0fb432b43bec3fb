from dartpy.dynamics import BoxShape, Skeleton, SphereShape
from dartpy.simulation import World

world, ground, ball = World("bounce"), Skeleton("ground"), Skeleton("ball")
world.setGravity([0, 0, -9.81]), world.setTimeStep(1e-3)
pairs = ground.createWeldJointAndBodyNodePair(), ball.createTranslationalJointAndBodyNodePair()
for (_, body), r in zip(pairs, (1.0, 0.75), strict=True):
    node = body.createShapeNode(BoxShape([9, 9, 1]) if r == 1 else SphereShape(0.1))
    node.createCollisionAspect(), node.createDynamicsAspect()
    node.getDynamicsAspect().setRestitutionCoeff(r)
world.addSkeleton(ground), world.addSkeleton(ball), ball.setPositions([0, 0, 1.6])
heights = [(world.step(), ball.getPositions()[2] - 0.6)[1] for _ in range(1100)]
