"""Stability over stiffness: where the 1-T, 2-T and 3-T orbits and their doublings are stable."""

import matplotlib.pyplot as plt

import bouncing_ball_beyond as bb

ball = bb.SpringDamper(restitution=0.85, frequency_ratio=10.0)
parameters = ("amplitude", "frequency_ratio")
ranges = {"frequency_ratio": (2.0, 100.0)}
figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
for n, colour in ((1, "#0072B2"), (2, "#C77C00"), (3, "#AA3A00")):
    orbit = bb.orbit(ball, n=n, amplitude=1.05 if n > 1 else 0.9)
    fold = bb.follow(orbit, to=0.1).first("saddle-node")
    doubling = bb.follow(orbit, to=1.6).first("period doubling")
    twice = bb.follow(doubling, to=1.6).first("period doubling")
    ends = ((fold, "-", "saddle-node"), (doubling, "--", "doubling"), (twice, ":", "next doubling"))
    for start, line, name in ends:
        curve = bb.special_curve(start, along=parameters, ranges=ranges).refined()
        label = f"{n}-T orbit: {name}"
        ratios, amplitudes = curve.z[:, :-3:-1].T
        axes.semilogx(ratios, amplitudes, line, color=colour, label=label)
axes.set(xlabel="frequency ratio ϖ of the contact", ylabel="amplitude Λ", title="r = 0.85")
axes.legend(fontsize=7, ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.15))
figure.savefig("stability_over_stiffness.png")
