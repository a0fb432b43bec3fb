# Error thresholds: the frequency ratio from which the restitution model is accurate. Datasets:
# relative errors over (quantity, frequency_ratio), thresholds over (quantity, tolerance).

ERROR_THRESHOLDS = {
    "fig14": "studies.error_thresholds.height_error",
    "thresholds": "studies.error_thresholds.error_thresholds",
}


use rule study as error_thresholds with:
    wildcard_constraints:
        artifact=stage(ERROR_THRESHOLDS),
