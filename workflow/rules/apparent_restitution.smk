# Apparent restitution, bouncing-off velocity and Poincaré map: orbits of the spring-damper
# model along the frequency ratio.

ALONG_FREQUENCY_RATIO = {
    "studies.frequency_sweeps.apparent_restitution": {
        "fig05": "Figure 5: apparent restitution along the frequency ratio, by restitution and amplitude",
        "fig06": "Figure 6: apparent restitution along the frequency ratio, by amplitude",
    },
    "studies.frequency_sweeps.frequency_sweep": {
        "fig10": "Figure 10: bouncing-off velocity along the frequency ratio",
    },
    "studies.frequency_sweeps.poincare_map": {
        "fig13": "Figure 13: Poincaré map of both models along the frequency ratio",
    },
}


use rule study as apparent_restitution with:
    wildcard_constraints:
        artifact=stages(ALONG_FREQUENCY_RATIO),
