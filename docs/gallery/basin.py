"""A basin: which first impacts lead to which motion in the long run?"""

import bouncing_ball

ball = bouncing_ball.rigid(restitution=0.85)
bouncing_ball.basins(ball, amplitude=0.95, starts=120).plot("basin.png")
