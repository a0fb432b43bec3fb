# The stages of beyond, in the same form as those of the paper. Each reads the accepted record of the
# paper, in `figures/` one folder above, and never a result of its rules.

# The verdicts on the paper's claims.
stage(
    "bouncing_ball.paper.claims.claims",
    claims=dict(title="Verdicts on the paper's claims", accepted="../figures/claims.nc"),
)


use rule study as corrected_model_study with:
    """The corrected restitution model, and how fast its errors fall along the frequency ratio."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.corrected_model",
            ext_instant=dict(
                title="Flights before and after a contact meet at the centroid of its force",
                study="meeting_flights",
                drawing="meeting_flights",
            ),
            ext_orders=dict(
                title="Order of convergence of the restitution model and of the corrected one",
                study="orders",
                drawing="orders",
                table="ext_orders",
            ),
        ),


use rule study as stiffness_map_study with:
    """How stiff a contact must be for the greatest height, over all stable orbits."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.stiffness_map",
            ext_map=dict(
                title="How stiff a contact must be for the greatest height, over r and Λ",
                study="stiffness_map",
                drawing="stiffness_map",
            ),
        ),


use rule study as release_rules_study with:
    """Contacts with another release rule."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.release_rules",
            ext_release=dict(
                title="Bifurcations and thresholds under both release rules",
                study="release_rules",
            ),
            ext_impact=dict(
                title="Restitution and duration of a free impact, by damping and release rule",
                study="free_impacts",
                drawing="free_impacts",
            ),
        ),


use rule study as contact_laws_study with:
    """Contacts with other laws."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.contact_laws",
            ext_laws=dict(
                title="Errors of the restitution model and of the corrected one on the contacts of engineers",
                study="law_errors",
                drawing="contact_laws",
                table="ext_laws",
            ),
        ),


use rule study as cascade_of_flights_study with:
    """Flights in a period above the threshold of permanent contact."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.cascade_of_flights",
            ext_flights=dict(
                title="From permanent contact to chattering: the cascade of flights in a period",
                study="cascade_of_flights",
                drawing="cascade_of_flights",
            ),
        ),


use rule study as explorer_orbits_study with:
    """Orbits with which the page of the explorer compares its results."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.explorer_orbits",
            explorer=dict(
                title="A page to explore the models, and the orbits that it checks itself against",
                study="reference_orbits",
                page=True,
            ),
        ),


use rule study as proofs_study with:
    """Numbers of the paper with intervals that certainly contain them."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.proofs",
            ext_proofs=dict(
                title="Printed numbers, certified by ball arithmetic",
                study="proofs",
                table="ext_proofs",
            ),
        ),


use rule study as certified_verdicts_study with:
    """The verdicts on printed numbers, decided by certified intervals."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball_beyond.exhibits.certified_verdicts",
            ext_verdicts=dict(
                title="Verdicts on the printed numbers by certified intervals",
                study="certified_verdicts",
                table="ext_verdicts",
                reads=("ext_proofs", "claims"),
            ),
        ),
