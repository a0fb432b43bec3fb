# Permanent contact: the amplitude from which the table throws the ball off.

PERMANENT_CONTACT = {
    "studies.permanent_contact_curve.permanent_contact": {
        "fig11": "Figure 11: threshold of permanent contact along the frequency ratio",
    },
    "studies.error_thresholds.permanent_contact_error": {
        "fig16": "Figure 16: threshold of permanent contact of both models",
    },
}


use rule study as permanent_contact with:
    wildcard_constraints:
        artifact=stages(PERMANENT_CONTACT),
