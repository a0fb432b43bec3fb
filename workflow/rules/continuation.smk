# Existence and stability of n-T orbits by continuation: from the restitution orbit along the
# frequency ratio to the contact wanted, then along the amplitude to both sides.

CONTINUATION = {
    "studies.orbit_branches.orbit_branches": {
        "fig08": "Figure 8: existence and stability domains of the spring-damper model, first family",
        "fig09": "Figure 9: existence and stability domains of the spring-damper model, second family",
    },
    "studies.orbit_branches.both_domains": {
        "fig15": "Figure 15: existence and stability domains of both models",
    },
    "studies.stability_ranges.stability_ranges": {
        "table1": "Table 1: stability ranges over the amplitude",
    },
}


use rule study as continuation_of_orbits with:
    wildcard_constraints:
        artifact=stages(CONTINUATION),
