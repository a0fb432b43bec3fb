# The page to explore the models, with the orbits that it checks itself against.

EXPLORER = Path(ROOT, "src/bouncing_ball/figures/explorer")


rule draw_explorer:
    message:
        "Writing results/figures/explorer.html"
    input:
        data="results/figures/explorer.nc",
        texts=sorted(
            os.path.relpath(path)
            for path in EXPLORER.iterdir()
            if path.suffix in (".js", ".css", ".j2")
        ),
        source=modules("figures.explorer.document", "datasets.netcdf", "datasets.files"),
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/explorer.log",
    benchmark:
        "results/benchmarks/explorer.tsv"
    script:
        "../scripts/explorer.py"
