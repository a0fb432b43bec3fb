"""A branch for three stiffnesses: a compliant contact widens the range of stable orbits."""

import bouncing_ball_beyond as bb

ratios = [2.0, 10.0, 100.0]
balls = bb.SpringDamper(frequency_ratio=ratios, restitution=0.85)
upwards = bb.follow(bb.orbit(balls, amplitude=0.9), to=1.3)
downwards = bb.follow(bb.orbit(balls, amplitude=0.9), to=0.1)
axes = None
for ratio, *branches in zip(ratios, upwards, downwards, strict=True):
    axes = bb.plot(*branches, ax=axes).axes[0]
axes.figure.savefig("branch_for_three_stiffnesses.png")
