"""The orbit diagram: the phases at which a ball lands in the long run, for each amplitude."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb
from paper_replication.drawing import SETTINGS, panels

plt.style.use(SETTINGS)

diagram = bb.orbit_diagram(bb.Rigid(0.7), amplitude=np.linspace(0.4, 2.0, 200))
phases = diagram.impact_phase.stack(landing=("start", "impact"))
figure, axes = panels(2.6)
axes.plot(diagram.amplitude, phases / np.pi, "k.", markersize=0.5)
axes.set(xlabel="amplitude Λ", ylabel="phase of impact over π", title="r = 0.7")
figure.savefig("orbit_diagram.png")
