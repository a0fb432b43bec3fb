"""Rebound speed over impact speed of a ball dropped from several heights."""

import bouncing_ball_beyond
import numpy as np
from bouncing_ball_beyond.models.damping import damping_ratio

GRAVITY, OMEGA, R = 9.81, 200.0, 0.75  # m/s^2, rad/s, r of a free impact
zeta = float(damping_ratio(R))
ball = bouncing_ball_beyond.spring_damper(restitution=R, frequency_ratio=OMEGA)

print("height in m  exact   first order")
for height in (1.0, 0.1, 0.01):
    v = np.sqrt(2 * GRAVITY * height)
    motion = bouncing_ball_beyond.simulate(ball, amplitude=0.0, velocity=-v / GRAVITY, impacts=2)
    before, after = motion.impact_velocity.values
    exact = after / before
    first = R - 2 * zeta * (1 + R) * GRAVITY / (OMEGA * v)
    print(f"{height:<11}  {exact:.4f}  {first:.4f}")
