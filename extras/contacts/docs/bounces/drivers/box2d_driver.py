import Box2D

world = Box2D.b2World(gravity=(0, -9.81))
edge = Box2D.b2EdgeShape(vertices=[(-9, 0), (9, 0)])
world.CreateStaticBody(fixtures=Box2D.b2FixtureDef(shape=edge))
circle = Box2D.b2CircleShape(radius=0.1)
fixture = Box2D.b2FixtureDef(shape=circle, density=1.0, restitution=0.75)
ball = world.CreateDynamicBody(position=(0, 1.1), fixtures=fixture)
heights = [(world.Step(1e-3, 8, 3), ball.position.y - 0.1)[1] for _ in range(1100)]
