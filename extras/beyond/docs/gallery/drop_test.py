"""How a drop test gives r: from the square root of the ratio of two successive heights."""

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb
from paper_replication.drawing import COLOURS, SETTINGS, panels

plt.style.use(SETTINGS)

ball = bb.SpringDamper(restitution=0.85, frequency_ratio=20.0)
motion = bb.drop(ball, height=8.0, periods=3.5, samples=5000)
height = motion.ball.values
time = motion.time.values
tops = np.flatnonzero((height[1:-1] > height[:-2]) & (height[1:-1] > height[2:])) + 1
tops = np.append(0, tops[~motion.contact.values[tops]])[:4]
figure, axes = panels(2.6)
axes.plot(time, height, color=COLOURS[1])
axes.plot(time[tops], height[tops], "o", color=COLOURS[1], markersize=4)
for before, after in pairwise(tops):
    text = f"√ratio: {np.sqrt(height[after] / height[before]):.4f}"
    axes.annotate(text, (time[after], height[after]), (0, 6), textcoords="offset points")
axes.set(xlabel="time over 1/Ω", ylabel="height over g/Ω²", xlim=(0, 26), ylim=(-0.5, 9))
axes.set_title("Contact with ϖ = 20, and damping for r = 0.85")
figure.savefig("drop_test.png")
