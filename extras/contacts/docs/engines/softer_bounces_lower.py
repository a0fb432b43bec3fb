"""The first three apexes of a dropped ball over those of a rigid one, by stiffness and r."""

import math

from bouncing_ball_contacts import Bounce, diagnose

GRAVITY, HEIGHT = 9.81, 0.4  # m/s², m above the height at which the ball touches
MASS = 2600 * 4 / 3 * math.pi * 0.1**3  # kg

print("k in N/m   r = 0.5            r = 0.7            r = 0.9")
for stiffness in (5e4, 5e5, 5e6):
    columns = []
    for r in (0.5, 0.7, 0.9):
        ratio = -math.log(r) / math.hypot(math.pi, math.log(r))
        contact = {"kn": stiffness, "gamma_n": 2 * ratio * math.sqrt(stiffness / MASS)}
        height = HEIGHT
        shares = []
        for bounce in range(1, 4):
            ball = Bounce(mass=MASS, drop_height=height, radius=0.1, gravity=GRAVITY)
            height *= diagnose(ball, "lammps", contact, 1e-6).numbers["limit"] ** 2
            shares.append(f"{height / (HEIGHT * r ** (2 * bounce)):.3f}")
        columns.append(" ".join(shares))
    print(f"{stiffness:.0e}      " + "  ".join(columns))
