# Stage: threshold of permanent contact (Eqs. 28-36).


rule permanent_contact:
    message:
        "Permanent contact threshold for {wildcards.figure}"
    input:
        source=modules("studies.permanent_contact_curve"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig11",
    params:
        parameters=figure_parameters,
        release=config["release"],
    log:
        "results/logs/permanent_contact/{figure}.log",
    benchmark:
        "results/benchmarks/permanent_contact/{figure}.tsv"
    script:
        "../scripts/permanent_contact.py"
