# The stages of the paper, each with the figures and tables whose datasets it makes: parameters in, a
# dataset out. workflow/artifacts.yaml says by which study. All values are dimensionless: times Ωt,
# lengths Ω²y/g, velocities Ωẏ/g, with phases in radians. Figures 1 and 4 are drawn without data.


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
    benchmark:
        "results/benchmarks/shards/{artifact}/{shard}.tsv"
    script:
        "../scripts/shard.py"


rule study:
    """What all stages have in common. It makes nothing itself."""
    message:
        "{wildcards.artifact}: {params.title}"
    input:
        data=lambda w: map(dataset, TABLE[w.artifact].get("reads", [])),
        shards=shards_of,
        source=lambda w: modules(STUDIES[w.artifact].rpartition(".")[0]),
    output:
        data="results/figures/{artifact}.nc",
    wildcard_constraints:
        # No name matches this.
        artifact="(?!)",
    params:
        study=lambda w: STUDIES[w.artifact],
        title=lambda w: TABLE[w.artifact].get("title", w.artifact),
        arguments=lambda w: arguments(STUDIES[w.artifact], w.artifact, config),
    log:
        "results/logs/stages/{artifact}.log",
    benchmark:
        "results/benchmarks/stages/{artifact}.tsv"
    script:
        "../scripts/study.py"


use rule study as restitution_model with:
    """The restitution model: one orbit over time, and all orbits in closed form."""
    wildcard_constraints:
        artifact="fig02|fig03",


use rule study as apparent_restitution with:
    """Apparent restitution, velocity and Poincaré map of orbits along the frequency ratio."""
    wildcard_constraints:
        artifact="fig05|fig06|fig10|fig13",


use rule study as time_histories with:
    """Time histories of orbits of the spring-damper model."""
    wildcard_constraints:
        artifact="fig07|fig12",


# From the restitution orbit along the frequency ratio to the contact in question, then along the
# amplitude to both sides.
use rule study as continuation_of_orbits with:
    """Existence and stability of n-T orbits by continuation, and their ranges in Table 1."""
    wildcard_constraints:
        artifact="fig08|fig09|fig15|table1",


use rule study as permanent_contact with:
    """Permanent contact: the amplitude from which on the table throws the ball off."""
    wildcard_constraints:
        artifact="fig11|fig16",


use rule study as error_thresholds with:
    """Error thresholds: the frequency ratio from which on the restitution model is accurate."""
    wildcard_constraints:
        artifact="fig14|thresholds",


# The release rule, the orbits of permanent contact, the corrected restitution model with its error
# law, contacts of other laws, the whole motion, physics engines, and the explorer.
use rule study as beyond_the_paper with:
    """Beyond the paper: what the release, the law and the steps of a contact change, and chaos."""
    wildcard_constraints:
        artifact="ext_[a-z]+|explorer",


use rule study as audit with:
    """The paper under audit: its formulas, Table 1, every orbit by three routes, its claims."""
    wildcard_constraints:
        artifact="formulas|forensics|witness|claims|statements",
