# Time histories of orbits of the spring-damper model: datasets over sample, for several contacts
# over (frequency_ratio, sample).

TIME_HISTORIES = {
    "fig07": "studies.time_histories.contact_history",
    "fig12": "studies.time_histories.both_histories",
}


use rule study as time_histories with:
    wildcard_constraints:
        artifact=stage(TIME_HISTORIES),
