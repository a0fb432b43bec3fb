# The page to explore the models, with reference orbits for the check of its results.
rule draw_explorer:
    message:
        "Writing results/figures/explorer.html"
    input:
        code=lambda wildcards: code("draw_explorer", f"{HOUSE}/workflow/explorer.py"),
        data="results/figures/explorer.nc",
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/explorer.log",
    conda:
        ENVIRONMENT
    script:
        "explorer.py"
