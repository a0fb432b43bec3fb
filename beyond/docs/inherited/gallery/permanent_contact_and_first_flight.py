"""Permanent contact and the first flight: a compliant contact opens at a smaller amplitude."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond.inherited as bouncing_ball

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
ratios = np.geomspace(1.2, 100, 300)
balls = bouncing_ball.spring_damper(restitution=0.65, frequency_ratio=ratios)
threshold = bouncing_ball.permanent_contact(balls).threshold_amplitude
left.semilogx(ratios, threshold, label="spring-damper contact")
left.axhline(1.0, color="grey", linestyle="--", label="rigid contact")
left.set(xlabel="frequency ratio ϖ", ylabel="amplitude Λ that lifts the ball", title="r = 0.65")
left.legend()
for amplitude, style in ((0.9, ":"), (1.05, "--"), (1.2, "-")):
    # Sixteen periods are enough for a gently dropped ball to come to rest, where it can.
    rigid = bouncing_ball.rigid(restitution=0.3)
    ball = bouncing_ball.drop(rigid, height=0.5, amplitude=amplitude, periods=18.0)
    last = ball.sel(time=slice(32 * np.pi, None))
    right.plot(last.time / (2 * np.pi), last.ball - last.table, style, label=f"Λ = {amplitude}")
right.set(xlabel="time in periods of the table", ylabel="height above the table", title="r = 0.3")
right.legend()
figure.savefig("permanent_contact_and_first_flight.png")
