# The stages of the paper. Each names its module in the package, and for each artifact the functions
# that compute its dataset (`study`), draw its figure (`drawing`) and list its table (`table`);
# `reads` names the artifacts whose datasets the study reads. The name of a rule is that of its module
# with `_study`; the name without it is the target that makes everything of the stage (targets.smk).

# The schematics have no dataset.
stage(
    "bouncing_ball.paper.exhibits.schematics",
    fig01=dict(
        title="Figure 1: schematic of the restitution model",
        drawing="restitution_model",
    ),
    fig04=dict(
        title="Figure 4: schematic of the spring-damper model",
        drawing="spring_damper_model",
    ),
)


use rule study as restitution_model_study with:
    """The restitution model: one orbit over time, and all orbits in closed form."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.restitution_model",
            fig02=dict(
                title="Figure 2: n-T response of the restitution model",
                study="restitution_history",
                drawing="restitution_history",
            ),
            fig03=dict(
                title="Figure 3: existence and stability domains of the restitution model",
                study="restitution_orbits",
                drawing="restitution_families",
            ),
        ),


use rule study as apparent_restitution_study with:
    """Apparent restitution, velocity and Poincaré map of orbits along the frequency ratio."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.apparent_restitution",
            fig05=dict(
                title="Figure 5: apparent restitution along the frequency ratio, by restitution and amplitude",
                study="apparent_restitution",
                drawing="apparent_restitution",
            ),
            fig06=dict(
                title="Figure 6: apparent restitution along the frequency ratio, by amplitude",
                study="apparent_restitution",
                drawing="apparent_restitution",
            ),
            fig10=dict(
                title="Figure 10: bouncing-off velocity along the frequency ratio",
                study="frequency_sweep",
                drawing="bounce_velocity",
            ),
            fig13=dict(
                title="Figure 13: Poincaré map of both models along the frequency ratio",
                study="poincare_map",
                drawing="poincare_map",
            ),
        ),


use rule study as time_histories_study with:
    """Time histories of orbits of the spring-damper model."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.time_histories",
            fig07=dict(
                title="Figure 7: one cycle of the spring-damper model",
                study="contact_history",
                drawing="contact_history",
            ),
            fig12=dict(
                title="Figure 12: time histories of both models",
                study="both_histories",
                drawing="both_histories",
            ),
        ),


use rule study as continuation_of_orbits_study with:
    """Existence and stability of n-T orbits by continuation, and their ranges in Table 1."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.continuation_of_orbits",
            fig08=dict(
                title="Figure 8: existence and stability domains of the spring-damper model, first family",
                study="orbit_branches",
                drawing="domains",
            ),
            fig09=dict(
                title="Figure 9: existence and stability domains of the spring-damper model, second family",
                study="orbit_branches",
                drawing="domains",
            ),
            fig15=dict(
                title="Figure 15: existence and stability domains of both models",
                study="both_domains",
                drawing="both_domains",
            ),
            table1=dict(
                title="Table 1: stability ranges over the amplitude",
                study="stability_ranges",
                table="table1",
            ),
        ),


use rule study as permanent_contact_study with:
    """Permanent contact: the amplitude from which on the table throws the ball off."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.permanent_contact",
            fig11=dict(
                title="Figure 11: threshold of permanent contact along the frequency ratio",
                study="permanent_contact",
                drawing="permanent_contact",
            ),
            fig16=dict(
                title="Figure 16: threshold of permanent contact of both models",
                study="permanent_contact_error",
                drawing="permanent_contact_error",
            ),
        ),


use rule study as error_thresholds_study with:
    """Error thresholds: the frequency ratio from which on the restitution model is accurate."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.error_thresholds",
            fig14=dict(
                title="Figure 14: greatest height of both models, and the threshold of the error",
                study="height_error",
                drawing="height_error",
            ),
            thresholds=dict(
                title="Frequency ratio from which the error of the restitution model is tolerable",
                study="error_thresholds",
                table="thresholds",
            ),
        ),


use rule study as lowest_period_doubling_study with:
    """The frequency ratio at which the period doubling of each family is lowest."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.lowest_period_doubling",
            lowest_doubling=dict(
                title="Frequency ratio at which the period doubling is lowest, by family",
                study="lowest_period_doublings",
            ),
        ),


use rule study as kinds_of_motion_study with:
    """A periodic, a subharmonic and a chaotic motion of the restitution model."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.kinds_of_motion",
            three_balls=dict(
                title="Periodic, subharmonic and chaotic motion of the restitution model, one ball for each",
                study="kinds_of_motion",
            ),
        ),


# The audit of the paper.


use rule study as formulas_study with:
    """The printed formulas against a second computation."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.claims.formulas",
            figures="bouncing_ball.paper.claims.tables",
            formulas=dict(
                title="The printed formulas against a second computation",
                study="formulas",
                table="formulas",
            ),
        ),


use rule study as forensics_study with:
    """Table 1 under readings of what the authors may have done."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.claims.forensics",
            figures="bouncing_ball.paper.claims.tables",
            forensics=dict(
                title="Table 1 under readings of what the authors may have done",
                study="forensics",
                table="forensics",
            ),
        ),


use rule study as witness_study with:
    """Every orbit shown by three routes: continuation, formula and simulation."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.claims.witness",
            figures="bouncing_ball.paper.claims.tables",
            witness=dict(
                title="Continuation, formula and simulation for every orbit shown",
                study="witness",
                table="witness",
                reads=(
                    "fig02",
                    "fig03",
                    "fig05",
                    "fig06",
                    "fig07",
                    "fig08",
                    "fig09",
                    "fig10",
                    "fig12",
                    "fig13",
                    "fig14",
                    "fig15",
                    "table1",
                ),
            ),
        ),


use rule study as claims_study with:
    """The verdicts on the paper's claims."""
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.claims.claims",
            figures="bouncing_ball.paper.claims.tables",
            claims=dict(
                title="Verdicts on the paper's claims",
                study="claims",
                table="claims",
                reads=(
                    "fig03",
                    "fig05",
                    "fig06",
                    "fig08",
                    "fig09",
                    "fig10",
                    "fig11",
                    "fig13",
                    "fig14",
                    "fig15",
                    "fig16",
                    "table1",
                    "thresholds",
                    "lowest_doubling",
                    "three_balls",
                    "formulas",
                    "forensics",
                    "witness",
                ),
            ),
        ),
