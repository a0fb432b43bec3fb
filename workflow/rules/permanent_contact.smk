# Permanent contact: the amplitude from which the table throws the ball off, a dataset over
# frequency_ratio.

PERMANENT_CONTACT = {
    "fig11": "studies.permanent_contact_curve.permanent_contact",
    "fig16": "studies.error_thresholds.permanent_contact_error",
}


use rule study as permanent_contact with:
    wildcard_constraints:
        artifact=stage(PERMANENT_CONTACT),
