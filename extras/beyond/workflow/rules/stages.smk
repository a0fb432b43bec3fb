# The stages: each computes the datasets of its figures.


rule compute_impacts:
    """One contact: its force, its ends, and the flights before and after it"""
    input:
        code=code("impacts"),
    output:
        **datasets("impacts"),
    params:
        config=config["impacts"],
        release=config["release"],
    log:
        "results/logs/compute_impacts.log",
    benchmark:
        "results/benchmarks/compute_impacts.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/impacts.py"


rule compute_error_law:
    """Errors of the restitution model and of the corrected model, and the error law"""
    input:
        code=code("error_law"),
    output:
        **datasets("error_law"),
    params:
        config=config["error_law"],
        release=config["release"],
    log:
        "results/logs/compute_error_law.log",
    benchmark:
        "results/benchmarks/compute_error_law.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/error_law.py"


rule compute_stiffness_map:
    """How stiff a contact must be for the greatest height"""
    input:
        code=code("stiffness_map"),
    output:
        **datasets("stiffness_map"),
    params:
        config=config["stiffness_map"],
    log:
        "results/logs/compute_stiffness_map.log",
    benchmark:
        "results/benchmarks/compute_stiffness_map.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/stiffness_map.py"


rule compute_contact_laws:
    """Errors on contacts of other laws"""
    input:
        code=code("contact_laws"),
    output:
        **datasets("contact_laws"),
    params:
        config=config["contact_laws"],
    log:
        "results/logs/compute_contact_laws.log",
    benchmark:
        "results/benchmarks/compute_contact_laws.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/contact_laws.py"


rule compute_phases:
    """What the phase of the touch tells about a contact"""
    input:
        code=code("phases"),
    output:
        **datasets("phases"),
    params:
        config=config["phases"],
    log:
        "results/logs/compute_phases.log",
    benchmark:
        "results/benchmarks/compute_phases.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/phases.py"


rule compute_events:
    """Motions from random starts on a contact and in both models"""
    input:
        code=code("events"),
    output:
        **datasets("events"),
    params:
        config=config["events"],
    log:
        "results/logs/compute_events.log",
    benchmark:
        "results/benchmarks/compute_events.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/events.py"


rule compute_explorer:
    """Orbits with which the explorer's page compares what it computes"""
    input:
        code=code("explorer"),
    output:
        **datasets("explorer"),
    params:
        config=config["explorer"],
    log:
        "results/logs/compute_explorer.log",
    benchmark:
        "results/benchmarks/compute_explorer.tsv"
    conda:
        ENVIRONMENT
    script:
        "../scripts/explorer.py"
