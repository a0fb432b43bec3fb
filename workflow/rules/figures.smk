# Renderings: one rule for each figure, called by its name.

for name in FIGURES:

    rule:
        name:
            name
        message:
            f"Drawing {name}"
        input:
            data=[] if name in SCHEMATICS else [f"results/figures/{name}.nc"],
            source=modules(f"render.figures.{name}", "render.figures.style", "datasets.netcdf"),
        output:
            png=report(
                f"results/figures/{name}.png",
                caption=f"../report/{name}.rst",
                category="Beyond the paper" if name in EXTENSIONS else "Figures",
                labels={"figure": name},
            ),
            svg=f"results/figures/{name}.svg",
        params:
            figure=name,
        log:
            f"results/logs/figures/{name}.log",
        benchmark:
            f"results/benchmarks/figures/{name}.tsv"
        script:
            "../scripts/figure.py"
