"""Chattering and rest: infinitely many impacts bring the ball to rest in a finite time."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb
from paper_replication.drawing import COLOURS, GUIDE, SETTINGS, panels

plt.style.use(SETTINGS)

ball = bb.Rigid(0.7)
motion = bb.drop(ball, height=8.0, amplitude=0.6, periods=5.0, samples=4000)
periods = motion.time / (2 * np.pi)
gap = motion.ball - motion.table
figure, (above, below) = panels(3.6, rows=2, sharex=True)
above.plot(periods, motion.ball, color=COLOURS[1], label="ball")
above.plot(periods, motion.table, **GUIDE, label="table")
above.set(title="Λ = 0.6, r = 0.7", ylabel="height")
above.legend()
below.semilogy(periods, gap.where(gap > 0), color=COLOURS[1])
below.set(xlabel="time in periods of the table", ylabel="height above the table", ylim=(1e-6, 10))
figure.savefig("chattering_and_rest.png")
