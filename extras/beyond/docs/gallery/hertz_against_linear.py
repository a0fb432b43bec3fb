"""Hertz against linear: both contacts have the same restitution coefficient and duration."""

import matplotlib.pyplot as plt

import bouncing_ball_beyond as bb

linear = bb.SpringDamper(restitution=0.85, frequency_ratio=10.0)
hertz = bb.tsuji(restitution=0.85, duration=0.3157, speed=3.4)
balls = {"linear": linear, "Hertz, with the damping of Tsuji": hertz}
figure, axes = plt.subplots(layout="constrained")
for (name, ball), style in zip(balls.items(), ("-", "--"), strict=True):
    found = bb.history(ball, amplitude=0.0, velocity=-3.4, periods=0.1, samples=5000)
    height = bb.orbit(ball, n=1, amplitude=1.0).max_height
    touching = found.where(found.contact, drop=True)
    axes.plot(touching.time, -touching.ball, style, label=f"{name}: greatest height {height:.4f}")
axes.set(xlabel="time since the impact over 1/Ω", ylabel="penetration over g/Ω²", ylim=(0, 0.42))
axes.set_title("One impact, and the height of the 1-T orbit (Λ = 1, r = 0.85)")
axes.legend()
figure.savefig("hertz_against_linear.png")
