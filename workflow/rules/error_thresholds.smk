# Error thresholds: the frequency ratio from which the restitution model is right.

ERROR_THRESHOLDS = {
    "studies.error_thresholds.height_error": {
        "fig14": "Figure 14: greatest height of both models, and the threshold of the error",
    },
    "studies.error_thresholds.error_thresholds": {
        "thresholds": "Frequency ratio from which the error of the restitution model is tolerable",
    },
}


use rule study as error_thresholds with:
    wildcard_constraints:
        artifact=stages(ERROR_THRESHOLDS),
