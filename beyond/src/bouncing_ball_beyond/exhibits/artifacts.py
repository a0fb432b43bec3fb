"""The figures and tables of beyond: the title of each, and the function that draws it."""

from bouncing_ball_beyond.inherited.datasets.artifact import Artifact, by_name

_EXHIBITS = "bouncing_ball_beyond.exhibits"

ARTIFACTS = by_name(
    Artifact(
        "ext_instant",
        "Flights before and after a contact meet at the centroid of its force",
        f"{_EXHIBITS}.corrected_model_figures:meeting_flights",
    ),
    Artifact(
        "ext_orders",
        "Order of convergence of the restitution model and of the corrected one",
        f"{_EXHIBITS}.corrected_model_figures:orders",
    ),
    Artifact(
        "ext_map",
        "How stiff a contact must be for the greatest height, over r and Λ",
        f"{_EXHIBITS}.stiffness_map_figures:stiffness_map",
    ),
    Artifact(
        "ext_release",
        "Bifurcations and thresholds under both release rules",
    ),
    Artifact(
        "ext_impact",
        "Restitution and duration of a free impact, by damping and release rule",
        f"{_EXHIBITS}.release_rules_figures:free_impacts",
    ),
    Artifact(
        "ext_laws",
        "Errors of the restitution model and of the corrected one on the contacts of engineers",
        f"{_EXHIBITS}.contact_laws_figures:contact_laws",
    ),
    Artifact(
        "ext_flights",
        "From permanent contact to chattering: the cascade of flights in a period",
        f"{_EXHIBITS}.cascade_of_flights_figures:cascade_of_flights",
    ),
    Artifact(
        "explorer",
        "A page to explore the models, and the orbits that it checks itself against",
    ),
)
