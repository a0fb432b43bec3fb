"""MuJoCo was asked for r = 0.75 and gave 0.820: what its parameters meant."""

from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.engine import Physical

MASS, STIFFNESS = 0.5, 284244.0  # kg, N/m
OMEGA = (STIFFNESS / MASS) ** 0.5
mujoco = ENGINES["mujoco"]

# k and c were multiplied by the mass; MuJoCo's numbers are k/m and c/m.
written = mujoco.read({"solref": "-284244 -68.8"}, MASS)
r = written.restitution(Release.FORCE)
print(f"as written         zeta = {written.damping_ratio:.4f}, r = {r:.4f}")

# The zeta that has r = 0.75 by either release, in MuJoCo, which has the force release.
for release in (Release.DISPLACEMENT, Release.FORCE):
    zeta = float(damping_ratio(0.75, release))
    contact = Physical(MASS, STIFFNESS, 2 * zeta * MASS * OMEGA)
    r = contact.restitution(Release.FORCE)
    print(f"for {release:12}   zeta = {zeta:.4f}, r = {r:.4f}")
