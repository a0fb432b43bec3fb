# Stage: what the release rule changes (beyond the paper).


rule release_rules:
    message:
        "Release rules for {wildcards.figure}"
    input:
        source=modules("studies.release_rules"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="ext_release",
    params:
        parameters=figure_parameters,
    log:
        "results/logs/release_rules/{figure}.log",
    benchmark:
        "results/benchmarks/release_rules/{figure}.tsv"
    script:
        "../scripts/release_rules.py"
