"""A basin: which first impacts lead to which motion in the long run?"""

import bouncing_ball

bouncing_ball.basins(0.95, restitution=0.85, starts=120).plot("basin.png")
