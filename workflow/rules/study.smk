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
            fig02="studies.restitution_families.restitution_history -> histories.restitution_history",
            fig03="studies.restitution_families.restitution_orbits -> branches.restitution_families",
        ),


use rule study as apparent_restitution with:
    """Apparent restitution, velocity and Poincaré map of orbits along the frequency ratio."""
    wildcard_constraints:
        artifact=stage(
            fig05="studies.frequency_sweeps.apparent_restitution -> sweeps.apparent_restitution",
            fig06="studies.frequency_sweeps.apparent_restitution -> sweeps.apparent_restitution",
            fig10="studies.frequency_sweeps.frequency_sweep -> sweeps.bounce_velocity",
            fig13="studies.frequency_sweeps.poincare_map -> sweeps.poincare_map",
        ),


use rule study as time_histories with:
    """Time histories of orbits of the spring-damper model."""
    wildcard_constraints:
        artifact=stage(
            fig07="studies.time_histories.contact_history -> histories.contact_history",
            fig12="studies.time_histories.both_histories -> histories.both_histories",
        ),


# From the restitution orbit along the frequency ratio to the contact in question, then along the
# amplitude to both sides.
use rule study as continuation_of_orbits with:
    """Existence and stability of n-T orbits by continuation, and their ranges in Table 1."""
    wildcard_constraints:
        artifact=stage(
            fig08="studies.orbit_branches.orbit_branches -> branches.domains",
            fig09="studies.orbit_branches.orbit_branches -> branches.domains",
            fig15="studies.both_models.both_domains -> branches.both_domains",
            table1="studies.both_models.stability_ranges",
        ),


use rule study as permanent_contact with:
    """Permanent contact: the amplitude from which on the table throws the ball off."""
    wildcard_constraints:
        artifact=stage(
            fig11="studies.permanent_contact_curve.permanent_contact -> thresholds.permanent_contact",
            fig16="studies.error_thresholds.permanent_contact_error -> thresholds.permanent_contact_error",
        ),


use rule study as error_thresholds with:
    """Error thresholds: the frequency ratio from which on the restitution model is accurate."""
    wildcard_constraints:
        artifact=stage(
            fig14="studies.error_thresholds.height_error -> thresholds.height_error",
            thresholds="studies.error_thresholds.error_thresholds",
        ),


# Beyond the paper.
use rule study as corrected_model with:
    """The corrected restitution model, and contacts with another release rule or another law."""
    wildcard_constraints:
        artifact=stage(
            ext_instant="studies.time_histories.meeting_flights -> histories.meeting_flights",
            ext_orders="studies.model_errors.orders -> model_errors.orders",
            ext_release="studies.release_rules.release_rules",
            ext_impact="studies.free_impacts.free_impacts -> free_impacts.free_impacts",
            ext_laws="studies.contact_laws.law_errors -> model_errors.contact_laws",
        ),


use rule study as whole_motion with:
    """The motions on which balls end: flights, cascades, basins, locking, chaos, and their means."""
    wildcard_constraints:
        artifact=stage(
            ext_flights="studies.cascade_of_flights.cascade_of_flights -> cascade_of_flights.cascade_of_flights",
            ext_cascades="studies.cascades.cascades -> cascades.cascades",
            ext_diagram="studies.attractors.orbit_diagrams -> attractors.orbit_diagrams",
            ext_basins="studies.basins.basins -> basins.basins",
            ext_locking="studies.attractors.locking -> attractors.locking",
            ext_lives="studies.transients.transients",
            ext_locked="studies.locked_orbits.locked_orbits -> locked_orbits.locked_orbits",
            ext_means="studies.mean_motion.mean_motions -> attractors.mean_motions",
        ),


use rule study as engines_and_explorer with:
    """Time steps of physics engines, and the reference orbits of the explorer."""
    wildcard_constraints:
        artifact=stage(
            ext_engines="studies.engines.conformance -> model_errors.engines",
            explorer="studies.reference_orbits.reference_orbits",
        ),


use rule study as audit with:
    """The paper under audit: its formulas, Table 1, every orbit by three routes, its claims."""
    wildcard_constraints:
        artifact=stage(
            formulas="claims.formulas.formulas",
            forensics="claims.forensics.forensics",
            witness="claims.witness.witness",
            claims="claims.ledger.ledger",
            statements="claims.ledger.statements",
        ),
