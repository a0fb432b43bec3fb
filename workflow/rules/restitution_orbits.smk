# Stage: n-T orbits of the restitution model, in closed form.


rule restitution_orbits:
    message:
        "Orbits of the restitution model for {wildcards.figure}"
    input:
        source=modules("studies.restitution_families"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig02|fig03",
    params:
        parameters=figure_parameters,
    log:
        "results/logs/restitution_orbits/{figure}.log",
    benchmark:
        "results/benchmarks/restitution_orbits/{figure}.tsv"
    script:
        "../scripts/restitution_orbits.py"
