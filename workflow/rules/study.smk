# The stages of the paper. Each lists the figures and tables whose datasets it makes, with the study
# that computes the dataset and the function that draws the figure. All values are dimensionless:
# times Ωt, lengths Ω²y/g, velocities Ωẏ/g, with phases in radians.


rule shard:
    """Some of the places of a study that has `shards` in its parameters."""
    message:
        "{wildcards.artifact}: shard {wildcards.shard}"
    input:
        source=lambda w: modules(TABLE[w.artifact]["places"].rpartition(".")[0]),
    output:
        data="results/shards/{artifact}/{shard}.nc",
    params:
        places=lambda w: TABLE[w.artifact]["places"],
        title=lambda w: f"{TABLE[w.artifact]['title']}: the places of one shard",
        arguments=lambda w: arguments(STUDIES[w.artifact], w.artifact, config),
    log:
        "results/logs/shards/{artifact}/{shard}.log",
    script:
        "../scripts/shard.py"


rule study:
    """What all stages have in common. It makes nothing itself."""
    message:
        "{wildcards.artifact}: {params.title}"
    input:
        data=lambda w: map(dataset, TABLE.get(w.artifact, {}).get("reads", [])),
        shards=shards_of,
        source=lambda w: modules(STUDIES[w.artifact].rpartition(".")[0]),
    output:
        data="results/figures/{artifact}.nc",
    wildcard_constraints:
        # No name matches this.
        artifact="(?!)",
    params:
        study=lambda w: STUDIES[w.artifact],
        title=lambda w: TABLE.get(w.artifact, {}).get("title", w.artifact),
        arguments=lambda w: arguments(STUDIES[w.artifact], w.artifact, config),
    log:
        "results/logs/stages/{artifact}.log",
    script:
        "../scripts/study.py"


use rule study as restitution_model with:
    """The restitution model: one orbit over time, and all orbits in closed form."""
    wildcard_constraints:
        artifact=stage(
            fig02="paper.exhibits.restitution_model.restitution_history -> paper.exhibits.restitution_model_figures.restitution_history",
            fig03="paper.exhibits.restitution_model.restitution_orbits -> paper.exhibits.restitution_model_figures.restitution_families",
        ),


use rule study as apparent_restitution with:
    """Apparent restitution, velocity and Poincaré map of orbits along the frequency ratio."""
    wildcard_constraints:
        artifact=stage(
            fig05="paper.exhibits.apparent_restitution.apparent_restitution -> paper.exhibits.apparent_restitution_figures.apparent_restitution",
            fig06="paper.exhibits.apparent_restitution.apparent_restitution -> paper.exhibits.apparent_restitution_figures.apparent_restitution",
            fig10="paper.exhibits.apparent_restitution.frequency_sweep -> paper.exhibits.apparent_restitution_figures.bounce_velocity",
            fig13="paper.exhibits.apparent_restitution.poincare_map -> paper.exhibits.apparent_restitution_figures.poincare_map",
        ),


use rule study as time_histories with:
    """Time histories of orbits of the spring-damper model."""
    wildcard_constraints:
        artifact=stage(
            fig07="paper.exhibits.time_histories.contact_history -> paper.exhibits.time_histories_figures.contact_history",
            fig12="paper.exhibits.time_histories.both_histories -> paper.exhibits.time_histories_figures.both_histories",
        ),


# From the restitution orbit along the frequency ratio to the contact in question, then along the
# amplitude to both sides.
use rule study as continuation_of_orbits with:
    """Existence and stability of n-T orbits by continuation, and their ranges in Table 1."""
    wildcard_constraints:
        artifact=stage(
            fig08="paper.exhibits.continuation_of_orbits.orbit_branches -> paper.exhibits.continuation_of_orbits_figures.domains",
            fig09="paper.exhibits.continuation_of_orbits.orbit_branches -> paper.exhibits.continuation_of_orbits_figures.domains",
            fig15="paper.exhibits.continuation_of_orbits.both_domains -> paper.exhibits.continuation_of_orbits_figures.both_domains",
            table1="paper.exhibits.continuation_of_orbits.stability_ranges",
        ),


use rule study as permanent_contact with:
    """Permanent contact: the amplitude from which on the table throws the ball off."""
    wildcard_constraints:
        artifact=stage(
            fig11="paper.exhibits.permanent_contact.permanent_contact -> paper.exhibits.permanent_contact_figures.permanent_contact",
            fig16="paper.exhibits.permanent_contact.permanent_contact_error -> paper.exhibits.permanent_contact_figures.permanent_contact_error",
        ),


use rule study as error_thresholds with:
    """Error thresholds: the frequency ratio from which on the restitution model is accurate."""
    wildcard_constraints:
        artifact=stage(
            fig14="paper.exhibits.error_thresholds.height_error -> paper.exhibits.error_thresholds_figures.height_error",
            thresholds="paper.exhibits.error_thresholds.error_thresholds",
        ),


use rule study as lowest_period_doubling with:
    """The frequency ratio at which the period doubling of each family is lowest."""
    wildcard_constraints:
        artifact=stage(
            lowest_doubling="paper.exhibits.lowest_period_doubling.lowest_period_doublings",
        ),


use rule study as kinds_of_motion with:
    """A periodic, a subharmonic and a chaotic motion of the restitution model."""
    wildcard_constraints:
        artifact=stage(
            three_balls="paper.exhibits.kinds_of_motion.kinds_of_motion",
        ),


# Beyond the paper.
use rule study as corrected_model with:
    """The corrected restitution model, and contacts with another release rule or another law."""
    wildcard_constraints:
        artifact=stage(
            ext_instant="beyond.exhibits.corrected_model.meeting_flights -> beyond.exhibits.corrected_model_figures.meeting_flights",
            ext_orders="beyond.exhibits.corrected_model.orders -> beyond.exhibits.corrected_model_figures.orders",
            ext_release="beyond.exhibits.release_rules.release_rules",
            ext_impact="beyond.exhibits.release_rules.free_impacts -> beyond.exhibits.release_rules_figures.free_impacts",
            ext_laws="beyond.exhibits.contact_laws.law_errors -> beyond.exhibits.contact_laws_figures.contact_laws",
        ),


use rule study as whole_motion with:
    """The motions on which balls end: flights, cascades, basins, locking, chaos, and their means."""
    wildcard_constraints:
        artifact=stage(
            ext_flights="beyond.exhibits.cascades.cascade_of_flights -> beyond.exhibits.cascades_figures.cascade_of_flights",
            ext_cascades="beyond.exhibits.cascades.cascades -> beyond.exhibits.cascades_figures.cascades",
            ext_diagram="beyond.exhibits.orbit_diagram.orbit_diagrams -> beyond.exhibits.orbit_diagram_figures.orbit_diagrams",
            ext_basins="beyond.exhibits.basins.basins -> beyond.exhibits.basins_figures.basins",
            ext_locking="beyond.exhibits.locking.locking -> beyond.exhibits.locking_figures.locking",
            ext_lives="beyond.exhibits.locked_orbits.transients",
            ext_locked="beyond.exhibits.locked_orbits.locked_orbits -> beyond.exhibits.locked_orbits_figures.locked_orbits",
            ext_means="beyond.exhibits.means.mean_motions -> beyond.exhibits.means_figures.mean_motions",
        ),


use rule study as engines_and_explorer with:
    """Time steps of physics engines, and the reference orbits of the explorer."""
    wildcard_constraints:
        artifact=stage(
            ext_engines="beyond.exhibits.engine_steps.conformance -> beyond.exhibits.engine_steps_figures.engines",
            explorer="beyond.exhibits.explorer_orbits.reference_orbits",
        ),


use rule study as audit with:
    """The paper under audit: its formulas, Table 1, every orbit by three routes, its claims."""
    wildcard_constraints:
        artifact=stage(
            formulas="paper.claims.formulas.formulas",
            forensics="paper.claims.forensics.forensics",
            witness="paper.claims.witness.witness",
            claims="paper.claims.claims.claims",
            statements="beyond.exhibits.statements.statements",
        ),
