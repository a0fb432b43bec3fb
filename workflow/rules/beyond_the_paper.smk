# Beyond the paper: the release rule, the orbits of permanent contact, the corrected restitution
# model with its error law, contacts of other laws, physics engines, and the explorer. What
# dimensions each dataset has is in the docstring of its study.

BEYOND_THE_PAPER = {
    "ext_release": "studies.release_rules.release_rules",
    "ext_rattling": "studies.long_contacts.cascade_of_flights",
    "ext_basins": "studies.long_contacts.basins",
    "ext_impact": "studies.free_impacts.free_impacts",
    "ext_instant": "studies.time_histories.meeting_flights",
    "ext_orders": "studies.model_errors.orders",
    "ext_laws": "studies.contact_laws.law_errors",
    "ext_hertz": "studies.contact_laws.figures_of_laws",
    "ext_cascades": "studies.cascades.cascades",
    "ext_diagram": "studies.attractors.orbit_diagrams",
    "ext_locking": "studies.attractors.locking",
    "ext_engines": "studies.engines.conformance",
    "explorer": "studies.reference_orbits.reference_orbits",
}
READS |= {"ext_engines": ["engines"]}


use rule study as beyond_the_paper with:
    wildcard_constraints:
        artifact=stage(BEYOND_THE_PAPER),
