"""Stability over stiffness: where the 1-T, 2-T and 3-T orbits and their doublings are stable."""

import matplotlib.pyplot as plt

import bouncing_ball_beyond as bb
from paper_replication.drawing import COLOURS, DASHES, SETTINGS, legend_below, panels, sample

plt.style.use(SETTINGS)

ball = bb.SpringDamper(restitution=0.85, frequency_ratio=10.0)
parameters = ("amplitude", "frequency_ratio")
ranges = {"frequency_ratio": (2.0, 100.0)}
figure, axes = panels(3.2)
names = ("saddle-node", "doubling", "next doubling")
looks = (DASHES[0], DASHES[1], DASHES[3])
entries = {}
for n, colour in enumerate(COLOURS[1:4], 1):
    orbit = bb.orbit(ball, n=n, amplitude=1.05 if n > 1 else 0.9)
    fold = bb.follow(orbit, to=0.1).first("saddle-node")
    doubling = bb.follow(orbit, to=1.6).first("period doubling")
    twice = bb.follow(doubling, to=1.6).first("period doubling")
    entries[f"{n}-T orbit"] = sample(color=colour)
    for start, line in zip((fold, doubling, twice), looks, strict=True):
        curve = bb.special_curve(start, along=parameters, ranges=ranges).refined()
        ratios, amplitudes = curve.z[:, :-3:-1].T
        axes.semilogx(ratios, amplitudes, color=colour, linestyle=line)
axes.set(xlabel="frequency ratio ϖ of the contact", ylabel="amplitude Λ", title="r = 0.85")
entries |= {name: sample(linestyle=line) for name, line in zip(names, looks, strict=True)}
legend_below(figure, entries)
figure.savefig("stability_over_stiffness.png")
