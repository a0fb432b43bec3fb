# Stage: n-T orbits of the spring-damper model by continuation (Eqs. 18-27).


rule continuation:
    message:
        "Continuation of the n-T orbits for {wildcards.figure}"
    input:
        source=modules("studies.orbit_branches"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig08|fig09|fig15|table1",
    params:
        parameters=figure_parameters,
        release=config["release"],
        continuation=config["continuation"],
        # Only Table 1 stands in print.
        printed=lambda wildcards: TABLE1 if wildcards.figure == "table1" else {},
    log:
        "results/logs/continuation/{figure}.log",
    benchmark:
        "results/benchmarks/continuation/{figure}.tsv"
    script:
        "../scripts/continuation.py"
