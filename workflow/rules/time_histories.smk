# Time histories of orbits of the spring-damper model.

TIME_HISTORIES = {
    "studies.time_histories.contact_history": {
        "fig07": "Figure 7: one cycle of the spring-damper model",
    },
    "studies.time_histories.both_histories": {
        "fig12": "Figure 12: time histories of both models",
    },
}


use rule study as time_histories with:
    wildcard_constraints:
        artifact=stages(TIME_HISTORIES),
