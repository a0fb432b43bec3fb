"""MuJoCo was asked for r = 0.75 and gave 0.820: what its parameters meant."""

from bouncing_ball_contacts import Bounce, diagnose

ball = Bounce(mass="500 g", restitution=0.75, radius="10 cm")
print(diagnose(ball, "mujoco", {"solref": "-284244 -68.8"}, "0.1 ms"))
