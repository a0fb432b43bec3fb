"""A doubling cascade: the motion repeats after 1, 2, 4, 8 … impacts, and then not at all."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb
from paper_replication.drawing import GUIDE, SETTINGS, panels

plt.style.use(SETTINGS)

amplitudes = np.linspace(1.48, 1.76, 400)
ball = bb.Rigid(0.5)
beside = bb.limits(ball).period_doubling.phase + 0.01
impacts = bb.motion_of(ball, amplitude=amplitudes, phase=beside).impacts
motions = bb.simulate(ball, amplitude=amplitudes, phase=beside, impacts=600)
figure, axes = panels(2.6)
axes.plot(amplitudes, motions.impact_phase[:, -64:] / np.pi, "k.", markersize=0.5)
for number in (2, 4, 8):
    first = float(impacts.amplitude[impacts == number].min())
    axes.axvline(first, **GUIDE)
    axes.text(first, 0.48, f"{number} ", color=GUIDE["color"], ha="right")
axes.set(xlabel="amplitude Λ", ylabel="phase of impact over π", title="r = 0.5")
figure.savefig("doubling_cascade.png")
