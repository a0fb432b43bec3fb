"""The longest step for r = 0.8 to 0.02, 0.01 and 0.002, in contacts of 1 ms, by the engine."""

from bouncing_ball_contacts import ENGINES, Bounce
from bouncing_ball_contacts.designs import Problem

ball = Bounce(mass="50 g", restitution=0.8, contact_time="1 ms", radius="30 mm")
print("engine    0.02      0.01      0.002")
for name in ("mujoco", "lammps", "pybullet", "drake", "newton"):
    steps = [Problem(ball, ENGINES[name], error).wanted().step for error in (0.02, 0.01, 0.002)]
    print(f"{name:<9} " + "  ".join(f"{step * 1e6:5.1f} µs" for step in steps))
