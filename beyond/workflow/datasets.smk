# The datasets of beyond, each computed by the study that its script imports. They read the accepted
# record of the paper, in `figures/` one folder above, and never a result of its rules.


rule ext_instant_study:
    """Flights before and after a contact, which meet at the centroid of its force."""
    message:
        "Computing ext_instant"
    input:
        code=code("ext_instant.py"),
    output:
        ext_instant="results/figures/ext_instant.nc",
    params:
        artifacts=about("ext_instant"),
        ext_instant=config["beyond"]["ext_instant"],
        release=config["release"],
    log:
        "results/logs/ext_instant.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_instant.py"


rule ext_orders_study:
    """How fast the errors of both models fall along the frequency ratio."""
    message:
        "Computing ext_orders"
    input:
        code=code("ext_orders.py"),
    output:
        ext_orders="results/figures/ext_orders.nc",
    params:
        artifacts=about("ext_orders"),
        ext_orders=config["beyond"]["ext_orders"],
        release=config["release"],
    log:
        "results/logs/ext_orders.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_orders.py"


rule ext_map_study:
    """How stiff a contact must be for the greatest height, over all stable orbits."""
    message:
        "Computing ext_map"
    input:
        code=code("ext_map.py"),
    output:
        ext_map="results/figures/ext_map.nc",
    params:
        artifacts=about("ext_map"),
        ext_map=config["beyond"]["ext_map"],
    log:
        "results/logs/ext_map.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_map.py"


rule ext_release_study:
    """Bifurcations and thresholds under both release rules."""
    message:
        "Computing ext_release"
    input:
        code=code("ext_release.py"),
    output:
        ext_release="results/figures/ext_release.nc",
    params:
        artifacts=about("ext_release"),
        ext_release=config["beyond"]["ext_release"],
    log:
        "results/logs/ext_release.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_release.py"


rule ext_impact_study:
    """Restitution and duration of a free impact."""
    message:
        "Computing ext_impact"
    input:
        code=code("ext_impact.py"),
    output:
        ext_impact="results/figures/ext_impact.nc",
    params:
        artifacts=about("ext_impact"),
        ext_impact=config["beyond"]["ext_impact"],
    log:
        "results/logs/ext_impact.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_impact.py"


rule ext_laws_study:
    """Errors of both models on contacts with other laws."""
    message:
        "Computing ext_laws"
    input:
        code=code("ext_laws.py"),
    output:
        ext_laws="results/figures/ext_laws.nc",
    params:
        artifacts=about("ext_laws"),
        ext_laws=config["beyond"]["ext_laws"],
    log:
        "results/logs/ext_laws.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_laws.py"


rule ext_flights_study:
    """Flights in a period above the threshold of permanent contact."""
    message:
        "Computing ext_flights"
    input:
        code=code("ext_flights.py"),
    output:
        ext_flights="results/figures/ext_flights.nc",
    params:
        artifacts=about("ext_flights"),
        ext_flights=config["beyond"]["ext_flights"],
    log:
        "results/logs/ext_flights.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_flights.py"


rule explorer_study:
    """Orbits with which the page of the explorer compares its results."""
    message:
        "Computing explorer"
    input:
        code=code("explorer.py"),
    output:
        explorer="results/figures/explorer.nc",
    params:
        artifacts=about("explorer"),
        explorer=config["beyond"]["explorer"],
    log:
        "results/logs/explorer.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/explorer.py"


rule ext_proofs_study:
    """Numbers of the paper with intervals that certainly contain them."""
    message:
        "Computing ext_proofs"
    input:
        code=code("ext_proofs.py"),
    output:
        ext_proofs="results/figures/ext_proofs.nc",
    params:
        artifacts=about("ext_proofs"),
        ext_proofs=config["beyond"]["ext_proofs"],
    log:
        "results/logs/ext_proofs.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_proofs.py"


rule ext_verdicts_study:
    """The verdicts on printed numbers, decided by certified intervals."""
    message:
        "Computing ext_verdicts"
    input:
        # An accepted dataset counts as code, because no job makes it.
        code=code("ext_verdicts.py", "../figures/claims.nc"),
        data=[
            "results/figures/ext_proofs.nc",
            "../figures/claims.nc",
        ],
    output:
        ext_verdicts="results/figures/ext_verdicts.nc",
    params:
        artifacts=about("ext_verdicts"),
    log:
        "results/logs/ext_verdicts.log",
    conda:
        ENVIRONMENT
    script:
        "scripts/ext_verdicts.py"
