"""A basin: which first impacts lead to which motion in the long run?"""

import bouncing_ball_beyond

ball = bouncing_ball_beyond.rigid(restitution=0.85)
bouncing_ball_beyond.basins(ball, amplitude=0.95, starts=120).plot("basin.png")
