# The restitution model: its orbits in closed form. Datasets: one orbit over time (sample), the
# branches over (n, point).

RESTITUTION_MODEL = {
    "fig02": "studies.restitution_families.restitution_history",
    "fig03": "studies.restitution_families.restitution_orbits",
}


use rule study as restitution_model with:
    wildcard_constraints:
        artifact=stage(RESTITUTION_MODEL),
