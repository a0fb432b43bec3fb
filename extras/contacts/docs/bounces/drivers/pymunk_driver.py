import pymunk

space = pymunk.Space()
space.gravity = (0, -9.81)
floor, ball = pymunk.Segment(space.static_body, (-9, -1), (9, -1), 1), pymunk.Body(1, 1)
circle = pymunk.Circle(ball, 0.1)
floor.elasticity, circle.elasticity, ball.position = 1.0, 0.75, (0, 1.1)
space.add(floor, ball, circle)
heights = [(space.step(1e-3), ball.position.y - 0.1)[1] for _ in range(1100)]
