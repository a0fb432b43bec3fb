"""A branch for three stiffnesses: a compliant contact widens the range of stable orbits."""

import bouncing_ball_beyond.inherited as bouncing_ball

balls = bouncing_ball.spring_damper(restitution=0.85, frequency_ratio=[2.0, 10.0, 100.0])
bouncing_ball.branch(balls, n=1).plot("branch_for_three_stiffnesses.png")
