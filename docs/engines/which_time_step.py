"""Steps in a contact for an error of r, and the error that 50 steps leave."""

from bouncing_ball.contacts.damping import damping_ratio, restitution_coefficient
from bouncing_ball.engines import ENGINES
from bouncing_ball.engines.scheme import restitution_in_steps, steps_for

print("engine   r     50 steps: error of r    0.01   0.001")
for name in ("mujoco", "lammps", "pybullet"):
    engine = ENGINES[name]
    release, scheme = engine.releases[0], engine.scheme
    for r in (0.5, 0.75, 0.9):
        zeta = float(damping_ratio(r, release))
        error = restitution_in_steps(scheme, zeta, release, 50)
        error = error - restitution_coefficient(zeta, release)
        steps = [steps_for(scheme, zeta, release, limit) for limit in (0.01, 0.001)]
        print(
            f"{name:8} {r:<4}  {error.min():+.4f} to {error.max():+.4f}   {steps[0]:6} {steps[1]:6}"
        )
