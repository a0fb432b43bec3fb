# Datasets in, figures out.

from bouncing_ball.figures import DRAWINGS

for name in FIGURES:

    rule:
        name:
            f"draw_{name}"
        message:
            f"Drawing {name}"
        input:
            data=datasets([name] if STAGES[name].study else []),
            source=modules(
                f"figures.{DRAWINGS[name]}".rpartition(".")[0],
                "figures.files",
                "datasets.netcdf",
            ),
            settings=os.path.relpath(Path(ROOT, "src/bouncing_ball/figures/matplotlibrc")),
        params:
            drawing=f"figures.{DRAWINGS[name]}",
        output:
            png=report(
                f"results/figures/{name}.png",
                caption=f"../report/{name if captioned(name) else 'figure'}.rst",
                category="Figures" if STAGES[name].kind is Kind.FIGURE else "Beyond the paper",
                labels={"figure": name},
            ),
            svg=f"results/figures/{name}.svg",
        log:
            f"results/logs/figures/{name}.log",
        benchmark:
            f"results/benchmarks/figures/{name}.tsv"
        script:
            "../scripts/figure.py"
