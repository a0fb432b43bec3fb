"""The corrected model against the exact one: its error falls as 1/ϖ², and not as 1/ϖ."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond

ratios = np.geomspace(3, 300, 100)
balls = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=ratios)
exact = bouncing_ball_beyond.orbit(balls, amplitude=1.0).max_height
corrected = bouncing_ball_beyond.orbit(
    bouncing_ball_beyond.corrected(balls), amplitude=1.0
).max_height
simple = bouncing_ball_beyond.orbit(
    bouncing_ball_beyond.rigid(restitution=0.85), amplitude=1.0
).max_height
figure, axes = plt.subplots(layout="constrained")
axes.loglog(ratios, abs(exact / simple - 1), label="restitution model")
axes.loglog(ratios, abs(exact / corrected - 1), "--", label="corrected model")
axes.axhline(0.01, color="grey", linestyle=":", label="1 %")
axes.set(xlabel="frequency ratio ϖ of the contact", ylabel="relative error of the greatest height")
axes.set_title("1-T orbit at Λ = 1, r = 0.85")
axes.legend()
figure.savefig("corrected_against_exact.png")
