"""Hertz against linear: both contacts have the same restitution coefficient and duration."""

import matplotlib.pyplot as plt

import bouncing_ball_beyond as bb
from paper_replication.drawing import COLOURS, DASHES, SETTINGS, legend_below, panels

plt.style.use(SETTINGS)

linear = bb.SpringDamper(restitution=0.85, frequency_ratio=10.0)
hertz = bb.tsuji(restitution=0.85, duration=0.3157, speed=3.4)
balls = {"linear": linear, "Hertz, Tsuji": hertz}
figure, axes = panels(2.8)
for (name, ball), colour, line in zip(balls.items(), COLOURS[1:3], DASHES[:2], strict=True):
    history = bb.history(ball, amplitude=0.0, velocity=-3.4, periods=0.1, samples=5000)
    height = bb.orbit(ball, n=1, amplitude=1.0).max_height
    touching = history.where(history.contact, drop=True)
    label = f"{name}: maximum height {height:.4f}"
    axes.plot(touching.time, -touching.ball, color=colour, linestyle=line, label=label)
axes.set(xlabel="time since the impact over 1/Ω", ylabel="penetration over g/Ω²", ylim=(0, 0.37))
axes.set_title("One impact, r = 0.85")
legend_below(figure)
figure.savefig("hertz_against_linear.png")
