"""Apexes of a dropped ball over those of a rigid one, by stiffness and restitution."""

import numpy as np

import bouncing_ball

GRAVITY, HEIGHT = 9.81, 0.4  # m/s^2, m above the height at which the ball touches
MASS = 2600 * 4 / 3 * np.pi * 0.1**3  # kg

print("k in N/m   r     apex 1  apex 2  apex 3")
for stiffness in (5e4, 5e5, 5e6):
    for restitution in (0.5, 0.7, 0.9):
        # The table rests: its angular frequency is only a unit of time, here 1 rad/s.
        motion = bouncing_ball.simulate(
            0.0,
            restitution=restitution,
            frequency_ratio=np.sqrt(stiffness / MASS),
            velocity=-np.sqrt(2 * GRAVITY * HEIGHT) / GRAVITY,
            impacts=4,
        )
        speed = -motion.impact_velocity
        apexes = (speed[1:] / speed[0] / restitution ** np.arange(1, 4)) ** 2
        print(f"{stiffness:.0e}    {restitution}", *(f"{apex:7.3f}" for apex in apexes))
