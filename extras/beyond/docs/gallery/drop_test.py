"""How a drop test gives r: the square root of the ratio of two successive heights is r."""

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb

ball = bb.SpringDamper(restitution=0.85, frequency_ratio=20.0)
found = bb.drop(ball, height=8.0, periods=3.5, samples=5000)
height = found.ball.values
time = found.time.values
tops = np.flatnonzero((height[1:-1] > height[:-2]) & (height[1:-1] > height[2:])) + 1
tops = np.append(0, tops[~found.contact.values[tops]])[:4]
figure, axes = plt.subplots(layout="constrained")
axes.plot(time, height)
axes.plot(time[tops], height[tops], "o", color="black")
for before, after in pairwise(tops):
    r = np.sqrt(height[after] / height[before])
    axes.annotate(f"r = {r:.4f}", (time[after], height[after]), (0, 8), textcoords="offset points")
axes.set(xlabel="time over 1/Ω", ylabel="height over g/Ω²", xlim=(0, 24), ylim=(-0.5, 9))
axes.set_title("Contact with ϖ = 20, and damping for r = 0.85")
figure.savefig("drop_test.png")
