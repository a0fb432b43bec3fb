# Existence and stability of n-T orbits by continuation: from the restitution orbit along the
# frequency ratio to the contact in question, then along the amplitude to both sides. Datasets:
# orbits over (frequency_ratio, point) with their special points over (frequency_ratio, special);
# of the table the stable ranges over (frequency_ratio, n, bound).

CONTINUATION = {
    "fig08": "studies.orbit_branches.orbit_branches",
    "fig09": "studies.orbit_branches.orbit_branches",
    "fig15": "studies.orbit_branches.both_domains",
    "table1": "studies.orbit_branches.stability_ranges",
}


use rule study as continuation_of_orbits with:
    wildcard_constraints:
        artifact=stage(CONTINUATION),
