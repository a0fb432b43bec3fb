# Beyond the paper: the release rule, the orbits of permanent contact, the corrected restitution
# model with its error law, contacts of other laws, and the explorer.

BEYOND_THE_PAPER = {
    "studies.release_rules.release_rules": {
        "ext_release": "Bifurcations and thresholds under both release rules",
    },
    "studies.long_contacts.stable_windows": {
        "ext_rattling": "Stable windows of the orbits into which permanent contact continues",
    },
    "studies.long_contacts.basins": {
        "ext_basins": "Basins of permanent contact and of the stable orbits",
    },
    "studies.model_errors.meeting_flights": {
        "ext_instant": "Flights before and after a contact meet at the centroid of its force",
    },
    "studies.model_errors.error_law_table": {
        "ext_error_law": "The first-order error of the restitution model, and what the corrected one leaves",
    },
    "studies.model_errors.orders": {
        "ext_orders": "Order of convergence of the restitution model and of the corrected one",
    },
    "studies.model_errors.validity": {
        "ext_validity": "Frequency ratio from which each model is right",
    },
    "studies.contact_laws.law_errors": {
        "ext_laws": "Errors of the restitution model and of the corrected one on the contacts of engineers",
    },
    "studies.contact_laws.figures_of_laws": {
        "ext_hertz": "Table 1 and Figures 8, 14 and 16 on contacts of other laws",
    },
    "studies.reference_orbits.reference_orbits": {
        "explorer": "A page to explore the models, and the orbits that it checks itself against",
    },
}


use rule study as beyond_the_paper with:
    wildcard_constraints:
        artifact=stages(BEYOND_THE_PAPER),


# The error law on 10⁵ random orbits under each release rule. Not part of a run, as it takes
# minutes; accepted by hand, `cp results/error_law.csv config/`, and the article takes its numbers
# from there.
rule error_law:
    message:
        "Error law on random orbits: some minutes"
    input:
        source=modules("studies.law_distribution", "datasets.files", "figures.tables.formats"),
    output:
        summary="results/error_law.csv",
    params:
        size=100_000,
        seed=config["extensions"]["ext_orders"]["random"]["seed"],
        span=config["extensions"]["ext_orders"]["frequency_ratio"],
    log:
        "results/logs/error_law.log",
    benchmark:
        "results/benchmarks/error_law.tsv"
    script:
        "../scripts/error_law.py"
