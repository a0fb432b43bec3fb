"""The corrected model against the exact one: its error falls as 1/ϖ², and not as 1/ϖ."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb
from paper_replication.drawing import COLOURS, DASHES, GUIDE, SETTINGS, legend_below, panels

plt.style.use(SETTINGS)

ratios = np.geomspace(3, 300, 100)
balls = bb.SpringDamper(frequency_ratio=ratios, restitution=0.85)


def heights(ball):
    return np.array([orbit.max_height for orbit in bb.orbit(ball, amplitude=1.0)])


exact = heights(balls)
simple = bb.orbit(bb.Rigid(0.85), amplitude=1.0).max_height
figure, axes = panels(2.8)
axes.loglog(ratios, abs(exact / simple - 1), color=COLOURS[1], label="restitution model")
errors = abs(exact / heights(bb.Corrected(balls)) - 1)
axes.loglog(ratios, errors, color=COLOURS[2], linestyle=DASHES[1], label="corrected model")
axes.axhline(0.01, **GUIDE, label="1 %")
axes.set(xlabel="frequency ratio ϖ of the contact", ylabel="error of the maximum height")
axes.set_title("1-T orbit at Λ = 1, r = 0.85")
legend_below(figure)
figure.savefig("corrected_against_exact.png")
