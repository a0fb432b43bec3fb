# Beyond the paper: the release rule, the orbits of permanent contact, the corrected restitution
# model with its error law, contacts of other laws, and the explorer.

BEYOND_THE_PAPER = {
    "ext_release": "studies.release_rules.release_rules",
    "ext_rattling": "studies.long_contacts.stable_windows",
    "ext_basins": "studies.long_contacts.basins",
    "ext_instant": "studies.model_errors.meeting_flights",
    "ext_error_law": "studies.model_errors.error_law_table",
    "ext_orders": "studies.model_errors.orders",
    "ext_validity": "studies.model_errors.validity",
    "ext_laws": "studies.contact_laws.law_errors",
    "ext_hertz": "studies.contact_laws.figures_of_laws",
    "explorer": "studies.reference_orbits.reference_orbits",
}


use rule study as beyond_the_paper with:
    wildcard_constraints:
        artifact=stage(BEYOND_THE_PAPER),


# The error law on 10⁵ random orbits under each release rule. Not part of a run, as it takes
# minutes; accepted by hand, `cp results/error_law.csv config/`, and the article takes its numbers
# from there.
rule error_law:
    message:
        "Error law on random orbits: some minutes"
    input:
        source=modules("studies.model_errors", "figures.tables.formats"),
    output:
        summary="results/error_law.csv",
    params:
        size=100_000,
        orders=lambda wildcards: config["extensions"]["ext_orders"],
    log:
        "results/logs/error_law.log",
    benchmark:
        "results/benchmarks/error_law.tsv"
    script:
        "../scripts/error_law.py"
