# Apparent restitution, bouncing-off velocity and Poincaré map: orbits of the spring-damper
# model along the frequency ratio. Each dataset has the observables of the stable orbits over
# (case, frequency_ratio), NaN where there is no orbit.

ALONG_FREQUENCY_RATIO = {
    "fig05": "studies.frequency_sweeps.apparent_restitution",
    "fig06": "studies.frequency_sweeps.apparent_restitution",
    "fig10": "studies.frequency_sweeps.frequency_sweep",
    "fig13": "studies.frequency_sweeps.poincare_map",
}


use rule study as apparent_restitution with:
    wildcard_constraints:
        artifact=stage(ALONG_FREQUENCY_RATIO),
