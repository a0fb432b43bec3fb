"""The figures, tables and checks of the paper: the title of each, and the function that draws it.

``workflow/rules/datasets.smk`` has the rules that make their datasets.
"""

from bouncing_ball.datasets.artifact import Artifact, by_name

_EXHIBITS = "bouncing_ball.paper.exhibits"

ARTIFACTS = by_name(
    Artifact(
        "fig01",
        "Figure 1: schematic of the restitution model",
    ),
    Artifact(
        "fig02",
        "Figure 2: n-T response of the restitution model",
        f"{_EXHIBITS}.restitution_model_figures:restitution_history",
    ),
    Artifact(
        "fig03",
        "Figure 3: existence and stability domains of the restitution model",
        f"{_EXHIBITS}.restitution_model_figures:restitution_families",
    ),
    Artifact(
        "fig04",
        "Figure 4: schematic of the spring-damper model",
    ),
    Artifact(
        "fig05",
        "Figure 5: apparent restitution along the frequency ratio, by restitution and amplitude",
        f"{_EXHIBITS}.apparent_restitution_figures:apparent_restitution",
    ),
    Artifact(
        "fig06",
        "Figure 6: apparent restitution along the frequency ratio, by amplitude",
        f"{_EXHIBITS}.apparent_restitution_figures:apparent_restitution",
    ),
    Artifact(
        "fig07",
        "Figure 7: one cycle of the spring-damper model",
        f"{_EXHIBITS}.time_histories_figures:contact_history",
    ),
    Artifact(
        "fig08",
        "Figure 8: existence and stability domains of the spring-damper model, first family",
        f"{_EXHIBITS}.continuation_of_orbits_figures:domains",
    ),
    Artifact(
        "fig09",
        "Figure 9: existence and stability domains of the spring-damper model, second family",
        f"{_EXHIBITS}.continuation_of_orbits_figures:domains",
    ),
    Artifact(
        "fig10",
        "Figure 10: bouncing-off velocity along the frequency ratio",
        f"{_EXHIBITS}.apparent_restitution_figures:bounce_velocity",
    ),
    Artifact(
        "fig11",
        "Figure 11: threshold of permanent contact along the frequency ratio",
        f"{_EXHIBITS}.permanent_contact_figures:permanent_contact",
    ),
    Artifact(
        "fig12",
        "Figure 12: time histories of both models",
        f"{_EXHIBITS}.time_histories_figures:both_histories",
    ),
    Artifact(
        "fig13",
        "Figure 13: Poincaré map of both models along the frequency ratio",
        f"{_EXHIBITS}.apparent_restitution_figures:poincare_map",
    ),
    Artifact(
        "fig14",
        "Figure 14: greatest height of both models, and the threshold of the error",
        f"{_EXHIBITS}.error_thresholds_figures:height_error",
    ),
    Artifact(
        "fig15",
        "Figure 15: existence and stability domains of both models",
        f"{_EXHIBITS}.continuation_of_orbits_figures:both_domains",
    ),
    Artifact(
        "fig16",
        "Figure 16: threshold of permanent contact of both models",
        f"{_EXHIBITS}.permanent_contact_figures:permanent_contact_error",
    ),
    Artifact(
        "table1",
        "Table 1: stability ranges over the amplitude",
    ),
    Artifact(
        "thresholds",
        "Frequency ratio from which the error of the restitution model is tolerable",
    ),
    Artifact(
        "lowest_doubling",
        "Frequency ratio at which the period doubling is lowest, by family",
    ),
    Artifact(
        "three_balls",
        "Periodic, subharmonic and chaotic motion of the restitution model, one ball for each",
    ),
    Artifact(
        "formulas",
        "The printed formulas against a second computation",
    ),
    Artifact(
        "forensics",
        "Table 1 under readings of what the authors may have done",
    ),
    Artifact(
        "witness",
        "Continuation, formula and simulation for every orbit shown",
    ),
    Artifact(
        "claims",
        "Verdicts on the paper's claims",
    ),
)
