"""The largest error of r that 50 steps in a contact leave, and the steps for a smaller one."""

from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.impacts import error_in_steps, steps_for

print("engine   r     50 steps  0.01  0.001")
for name in ("mujoco", "lammps", "pybullet"):
    engine = ENGINES[name]
    release, scheme = engine.releases[0], engine.scheme
    for r in (0.5, 0.9):
        zeta = float(damping_ratio(r, release))
        error = error_in_steps(scheme, zeta, release, 50)
        steps = [steps_for(scheme, zeta, release, limit) for limit in (0.01, 0.001)]
        print(f"{name:8} {r:<4}  {error:8.4f}  {steps[0]:4}  {steps[1]:5}")
