"""Laws against a real ball: restitution coefficients of croquet, and the laws fitted to them."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_contacts

# D. Gugan, Experiments on the game of croquet: bouncing and rolling balls, Table I.
speed = np.array([0.50, 1.00, 1.64, 2.04, 2.00, 2.83, 3.51, 4.43, 5.47, 6.01])
measured = np.array([85.7, 84.2, 82.9, 82.4, 82.7, 81.7, 81.1, 80.6, 79.9, 79.5]) / 100
fit = bouncing_ball_contacts.fit_contact(speed, measured)
shown = np.linspace(0.2, 6.5, 200)
figure, axes = plt.subplots(layout="constrained")
axes.plot(speed, measured, "o", color="black", label="measured")
for name in ("kuwabara-kono", "tsuji", "hunt-crossley"):
    law = fit.law(name)
    (line,) = axes.plot(shown, law.restitution_at(shown), label=f"{name}, rms {law.rms:.4f}")
    axes.fill_between(shown, *law.band(shown), color=line.get_color(), alpha=0.2)
axes.set(xlabel="impact speed in m/s", ylabel="restitution coefficient")
axes.set(ylim=(0.75, 0.9), title="Croquet ball on wood, with 95 % bands")
axes.legend(loc="lower left")
figure.savefig("measured_impacts.png")
