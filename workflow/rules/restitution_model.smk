# The restitution model: its orbits in closed form, and what its balls do beside them.

RESTITUTION_MODEL = {
    "fig02": "studies.restitution_families.restitution_history",
    "fig03": "studies.restitution_families.restitution_orbits",
    "motions": "studies.kinds_of_motion.kinds_of_motion",
}


use rule study as restitution_model with:
    wildcard_constraints:
        artifact=stage(RESTITUTION_MODEL),
