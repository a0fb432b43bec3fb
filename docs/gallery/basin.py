"""A basin: which balls end on the 1-T orbit, which on the 2-T orbit, and so on?"""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball

phase = np.linspace(-np.pi, np.pi, 160)
speed = np.linspace(1, 14, 120)[:, np.newaxis]
found = bouncing_ball.simulate(
    0.95, phase=phase, velocity=0.95 * np.cos(phase) - speed, restitution=0.85, impacts=300
)
periods = np.round((found.time[-1] - found.time[-2]) / (2 * np.pi))
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
image = axes.pcolormesh(phase / np.pi, speed[:, 0], periods, cmap=plt.get_cmap("viridis", 3))
figure.colorbar(image, ticks=[1, 2, 3], label="periods between the last two impacts")
axes.set(xlabel="phase of the first impact over π", ylabel="speed against the table")
axes.set_title("Λ = 0.95, r = 0.85; white: the ball comes to rest on the table")
figure.savefig("basin.png")
