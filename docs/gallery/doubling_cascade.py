"""A doubling cascade: 1 impact in a repetition becomes 2, 4, 8 … and then none repeats."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball

doubling = bouncing_ball.limits(1, restitution=0.5).period_doubling
amplitudes = np.linspace(1.48, 1.76, 700)
found = bouncing_ball.simulate(
    amplitudes, phase=doubling.phase + 0.01, velocity=-np.pi, restitution=0.5, impacts=600
)
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
axes.plot(amplitudes, found.phase[-64:].T / np.pi, ",", color="black")
axes.axvline(doubling.amplitude, color="grey", linestyle="--", linewidth=1)
axes.set(xlabel="amplitude Λ (dashed: first period doubling)", ylabel="phase of impact over π")
axes.set(title="r = 0.5: the last 64 of 600 impacts that begin beside the 1-T orbit")
figure.savefig("doubling_cascade.png")
