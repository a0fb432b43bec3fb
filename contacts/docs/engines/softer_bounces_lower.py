"""The first three apexes of a dropped ball over those of a rigid one, by stiffness and r."""

import bouncing_ball_beyond
import numpy as np

GRAVITY, HEIGHT = 9.81, 0.4  # m/s^2, m above the height at which the ball touches
MASS = 2600 * 4 / 3 * np.pi * 0.1**3  # kg
RESTITUTIONS = np.array([0.5, 0.7, 0.9])

print("k in N/m " + "".join(f"  r = {r:<13}" for r in RESTITUTIONS).rstrip())
for stiffness in (5e4, 5e5, 5e6):
    # The table rests: its angular frequency is only a unit of time, here 1 rad/s.
    balls = bouncing_ball_beyond.spring_damper(
        restitution=RESTITUTIONS, frequency_ratio=np.sqrt(stiffness / MASS)
    )
    fall = np.sqrt(2 * GRAVITY * HEIGHT) / GRAVITY
    motion = bouncing_ball_beyond.simulate(balls, amplitude=0.0, velocity=-fall, impacts=4)
    speed = motion.impact_velocity.values.T
    rigid = RESTITUTIONS ** np.arange(1, 4)[:, None]
    apexes = (speed[1:] / speed[0] / rigid) ** 2
    print(f"{stiffness:.0e}    " + "".join(f"  {x:.3f} {y:.3f} {z:.3f}" for x, y, z in apexes.T))
