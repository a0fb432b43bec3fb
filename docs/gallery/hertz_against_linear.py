"""Hertz against linear: both contacts have the same restitution coefficient and duration."""

import matplotlib.pyplot as plt

import bouncing_ball

laws = {
    "linear": {"frequency_ratio": 10.0},
    "Hertz, with the damping of Tsuji": {"law": "tsuji", "duration": 0.3157},
}
figure, axes = plt.subplots(layout="constrained")
for (name, impact), style in zip(laws.items(), ("-", "--"), strict=True):
    impact["restitution"] = 0.85
    ball = bouncing_ball.history(0.0, velocity=-3.4, periods=0.1, samples=5000, **impact)
    height = bouncing_ball.orbit(1, 1.0, **impact).max_height
    touching = ball.where(ball.contact, drop=True)
    axes.plot(touching.time, -touching.ball, style, label=f"{name}: greatest height {height:.4f}")
axes.set(xlabel="time since the impact over 1/Ω", ylabel="penetration over g/Ω²", ylim=(0, 0.42))
axes.set_title("One impact, and the height of the 1-T orbit (Λ = 1, r = 0.85)")
axes.legend()
figure.savefig("hertz_against_linear.png")
