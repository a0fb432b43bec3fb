"""√(h′/h) of a ball dropped from several heights, ω = 200 rad/s, beside the first order."""

import math

from bouncing_ball_contacts import Bounce, diagnose

GRAVITY, OMEGA, R = 9.81, 200.0, 0.75  # m/s², rad/s, r of a free impact of a damper that pulls
ratio = -math.log(R) / math.hypot(math.pi, math.log(R))
contact = {"kn": OMEGA**2, "gamma_n": 2 * ratio * OMEGA}

print("height in m  √(h′/h)  first order")
for height in (1.0, 0.1, 0.01):
    ball = Bounce(mass=1.0, drop_height=height, radius=1.0, gravity=GRAVITY)
    limit = diagnose(ball, "lammps", contact, 5e-6).numbers["limit"]
    v = math.sqrt(2 * GRAVITY * height)
    first = R - 2 * ratio * (1 + R) * GRAVITY / (OMEGA * v)
    print(f"{height:<11}  {limit:.3f}    {first:.3f}")
