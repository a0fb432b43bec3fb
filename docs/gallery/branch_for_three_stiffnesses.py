"""A branch for three stiffnesses: a compliant contact widens the range of stable orbits."""

import bouncing_ball

found = bouncing_ball.branch(1, restitution=0.85, frequency_ratio=[2.0, 10.0, 100.0])
found.plot("branch_for_three_stiffnesses.png")
