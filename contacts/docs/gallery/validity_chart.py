"""The validity chart with your contact: where is a restitution coefficient enough?"""

import bouncing_ball_beyond
import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_contacts

ours = bouncing_ball_contacts.assess_contact(
    bouncing_ball_contacts.Table(frequency="50 Hz", acceleration="0.8 g"),
    bouncing_ball_contacts.Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85),
)
r = np.linspace(0.6, 1.0, 81)
ratio = np.geomspace(5, 1000, 80)
balls = bouncing_ball_beyond.spring_damper(restitution=r, frequency_ratio=ratio)
exact = bouncing_ball_beyond.orbit(balls, amplitude=ours.amplitude)
simple = bouncing_ball_beyond.orbit(
    bouncing_ball_beyond.rigid(restitution=r), amplitude=ours.amplitude
)
percent = 100 * abs(exact.max_height / simple.max_height - 1)
figure, axes = plt.subplots(layout="constrained")
lines = axes.contour(r, ratio, percent.T, levels=[0.1, 1, 10], colors="black")
axes.clabel(lines, fmt="%g %%")
axes.plot(ours.restitution["displacement"], ours.frequency_ratio, "*", markersize=15)
axes.set(xlabel="restitution coefficient r", ylabel="frequency ratio ϖ", yscale="log")
axes.set_title(f"Error of the greatest height, 1-T orbit, Λ = {ours.amplitude:.2g}; star: ours")
figure.savefig("validity_chart.png")
