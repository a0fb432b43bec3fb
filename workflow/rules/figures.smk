# Datasets in, figures out: each figure from the dataset of its name. The schematics, Figures 1
# and 4, have none.

from bouncing_ball.figures import DRAWINGS

for name, drawing in DRAWINGS.items():

    rule:
        name:
            f"draw_{name}"
        message:
            f"Drawing {name}"
        input:
            data=datasets([name] if name in STUDIES else []),
            source=modules(
                f"figures.{drawing}".rpartition(".")[0],
                "figures.files",
                "figures.given",
                "datasets.netcdf",
            ),
        params:
            drawing=f"figures.{drawing}",
        output:
            png=report(
                f"results/figures/{name}.png",
                caption=f"../report/{caption(name)}.rst",
                category="Figures" if name.startswith("fig") else "Beyond the paper",
                labels={"figure": name},
            ),
            svg=f"results/figures/{name}.svg",
        log:
            f"results/logs/figures/{name}.log",
        benchmark:
            f"results/benchmarks/figures/{name}.tsv"
        script:
            "../scripts/figure.py"
