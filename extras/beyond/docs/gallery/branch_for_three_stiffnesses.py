"""A branch for three stiffnesses: a compliant contact widens the range of stable orbits."""

import bouncing_ball_beyond as bb

balls = bb.SpringDamper(frequency_ratio=[2.0, 10.0, 100.0], restitution=0.85)
branches = bb.follow(bb.orbit(balls, amplitude=0.9), to=(0.1, 1.3))
bb.plot(*branches).savefig("branch_for_three_stiffnesses.png")
