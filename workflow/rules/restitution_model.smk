# The restitution model: its orbits in closed form, and what its balls do beside them.

RESTITUTION_MODEL = {
    "studies.restitution_families.restitution_history": {
        "fig02": "Figure 2: n-T response of the restitution model",
    },
    "studies.restitution_families.restitution_orbits": {
        "fig03": "Figure 3: existence and stability domains of the restitution model",
    },
    "studies.kinds_of_motion.kinds_of_motion": {
        "motions": "Kinds of motion of the restitution model",
    },
}


use rule study as restitution_model with:
    wildcard_constraints:
        artifact=stages(RESTITUTION_MODEL),
