"""Datasets turned into figures, tables and the article; nothing is computed here.

A drawing is a function ``draw(dataset) -> Figure`` of the dataset that its study makes, whose
docstring names the variables; schematics take no dataset. Figures of one kind share a module.
Functions whose name begins with an underscore draw a part of a figure into given axes. Sizes are
in inches, offsets of texts in points; axes show phases and velocities over π where they say so.
A dataset without a variable that is drawn raises :class:`AttributeError` or :class:`KeyError`.
"""

DRAWINGS = {
    "fig01": "schematics.restitution_model",
    "fig02": "histories.restitution_history",
    "fig03": "branches.restitution_families",
    "fig04": "schematics.spring_damper_model",
    "fig05": "sweeps.apparent_restitution",
    "fig06": "sweeps.apparent_restitution",
    "fig07": "histories.contact_history",
    "fig08": "branches.domains",
    "fig09": "branches.domains",
    "fig10": "sweeps.bounce_velocity",
    "fig11": "thresholds.permanent_contact",
    "fig12": "histories.both_histories",
    "fig13": "sweeps.poincare_map",
    "fig14": "thresholds.height_error",
    "fig15": "branches.both_domains",
    "fig16": "thresholds.permanent_contact_error",
    "ext_release": "thresholds.release_rules",
    "ext_rattling": "long_contacts.cascade_of_flights",
    "ext_basins": "long_contacts.basins",
    "ext_impact": "free_impacts.free_impacts",
    "ext_instant": "histories.meeting_flights",
    "ext_orders": "model_errors.orders",
    "ext_laws": "model_errors.contact_laws",
    "ext_hertz": "model_errors.figures_of_laws",
    "ext_cascades": "cascades.cascades",
    "ext_diagram": "attractors.orbit_diagrams",
    "ext_locking": "attractors.locking",
    "ext_engines": "model_errors.engines",
}
"""Where each figure is drawn: ``module.function`` of this package."""
