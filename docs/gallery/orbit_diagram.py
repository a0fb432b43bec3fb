"""The orbit diagram: on which phases does the ball land when the first impacts are forgotten?"""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball

amplitudes = np.linspace(0.2, 2.5, 600)
found = bouncing_ball.simulate(amplitudes, restitution=0.85, impacts=300)
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
axes.plot(amplitudes, found.phase[-60:].T / np.pi, ",", color="black")
axes.set(
    xlabel="amplitude Λ", ylabel="phase of impact over π", title="r = 0.85, impacts 241 to 300"
)
figure.savefig("orbit_diagram.png")
