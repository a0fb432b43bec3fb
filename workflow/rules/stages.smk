# The stages: each computes the datasets of its figures and tables.


rule compute_restitution_model:
    """Motions and orbits of the restitution model"""
    input:
        code=code("restitution_model"),
    output:
        **datasets("restitution_model"),
    params:
        config=config["restitution_model"],
    log:
        "results/logs/compute_restitution_model.log",
    benchmark:
        "results/benchmarks/compute_restitution_model.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/restitution_model.py"


rule compute_apparent_restitution:
    """Orbits of the spring-damper model along the frequency ratio"""
    input:
        code=code("apparent_restitution"),
    output:
        **datasets("apparent_restitution"),
    params:
        config=config["apparent_restitution"],
        release=config["release"],
    log:
        "results/logs/compute_apparent_restitution.log",
    benchmark:
        "results/benchmarks/compute_apparent_restitution.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/apparent_restitution.py"


rule compute_continuation:
    """Branches of n-T orbits along the amplitude, with their bifurcations"""
    input:
        printed=checkout(PRINTED),
        code=code("continuation"),
    output:
        **datasets("continuation"),
    params:
        config=config["continuation"],
        release=config["release"],
        largest_step=config["largest_step"],
    log:
        "results/logs/compute_continuation.log",
    benchmark:
        "results/benchmarks/compute_continuation.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/continuation.py"


rule compute_table1_readings:
    """Table 1 under hypotheses about what the authors may have computed"""
    input:
        printed=checkout(PRINTED),
        code=code("table1_readings"),
    output:
        **datasets("table1_readings"),
    log:
        "results/logs/compute_table1_readings.log",
    benchmark:
        "results/benchmarks/compute_table1_readings.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/table1_readings.py"


rule compute_permanent_contact:
    """Amplitudes up to which the ball stays on the table"""
    input:
        code=code("permanent_contact"),
    output:
        **datasets("permanent_contact"),
    params:
        config=config["permanent_contact"],
        release=config["release"],
    log:
        "results/logs/compute_permanent_contact.log",
    benchmark:
        "results/benchmarks/compute_permanent_contact.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/permanent_contact.py"


rule compute_error_thresholds:
    """Errors of the restitution model along the frequency ratio"""
    input:
        code=code("error_thresholds"),
    output:
        **datasets("error_thresholds"),
    params:
        config=config["error_thresholds"],
        release=config["release"],
    log:
        "results/logs/compute_error_thresholds.log",
    benchmark:
        "results/benchmarks/compute_error_thresholds.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/error_thresholds.py"


rule compute_time_histories:
    """Positions of ball and table over time"""
    input:
        code=code("time_histories"),
    output:
        **datasets("time_histories"),
    params:
        config=config["time_histories"],
        release=config["release"],
    log:
        "results/logs/compute_time_histories.log",
    benchmark:
        "results/benchmarks/compute_time_histories.tsv"
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/time_histories.py"
