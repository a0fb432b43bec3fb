"""The orbit diagram: the phases at which a ball lands in the long run, for each amplitude."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb

found = bb.orbit_diagram(bb.Rigid(0.7), amplitude=np.linspace(0.4, 2.0, 200))
phases = found.impact_phase.stack(landing=("start", "impact"))
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
axes.plot(found.amplitude, phases / np.pi, ",", color="black")
axes.set(xlabel="amplitude Λ", ylabel="phase of impact over π", title="r = 0.7")
figure.savefig("orbit_diagram.png")
