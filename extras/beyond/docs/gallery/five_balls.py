"""Five balls that start alike and part: their initial speeds differ by a thousandth."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter

import bouncing_ball_beyond as bb

speeds = np.pi + 1e-3 * np.arange(5)
ball = bb.Rigid(0.7)
found = bb.history(ball, amplitude=1.85, velocity=-speeds, periods=12.0, samples=6)
figure, axes = plt.subplots(figsize=(4, 4), dpi=60, gridspec_kw={"left": 0.17})
balls = axes.scatter(range(5), np.zeros(5), s=120, color="tab:blue")
(table,) = axes.plot([-0.5, 4.5], [0, 0], color="black", linewidth=3)
axes.set(ylim=(-2, float(found.ball.max()) + 1), xticks=[], ylabel="height over g/Ω²")


def draw(frame):
    now = found.isel(time=frame)
    balls.set_offsets(np.c_[np.arange(5), now.ball])
    table.set_ydata(np.full(2, now.table[0]))
    axes.set_title(f"Λ = 1.85, r = 0.7, period {float(now.time) / (2 * np.pi):.1f}")


FuncAnimation(figure, draw, found.sizes["time"]).save("five_balls.gif", PillowWriter(fps=8))
