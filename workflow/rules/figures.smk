# Figures are drawn from their datasets; those of the models need none.


rule figure:
    """Draws one figure from its dataset"""
    input:
        data=branch(
            lambda wildcards: wildcards.figure in SCHEMATICS,
            then=[],
            otherwise="results/figures/{figure}.nc",
        ),
        code=code("draw"),
    output:
        png=report(
            "results/figures/{figure}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels={"figure": "{figure}"},
        ),
        svg="results/figures/{figure}.svg",
    log:
        "results/logs/{figure}.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"
