# The restitution model: its orbits in closed form, and the motion of balls that start beside
# them. Datasets: one orbit over time (sample), the branches over (n, point), the motions over case.

RESTITUTION_MODEL = {
    "fig02": "studies.restitution_families.restitution_history",
    "fig03": "studies.restitution_families.restitution_orbits",
    "motions": "studies.kinds_of_motion.kinds_of_motion",
}


use rule study as restitution_model with:
    wildcard_constraints:
        artifact=stage(RESTITUTION_MODEL),
