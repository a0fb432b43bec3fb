# Datasets in, figures out: each figure from the dataset of its name. The schematics, Figures 1
# and 4, have none.

from bouncing_ball.figures import DRAWINGS


def caption(name):
    own = Path(ROOT, f"workflow/report/{name}.rst").is_file()
    return f"../report/{name if own else 'figure'}.rst"


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
                "datasets.netcdf",
            ),
            settings=os.path.relpath(Path(ROOT, "src/bouncing_ball/figures/matplotlibrc")),
        params:
            drawing=f"figures.{drawing}",
        output:
            png=report(
                f"results/figures/{name}.png",
                caption=caption(name),
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


# The page to explore the models, with the orbits that it checks itself against.
rule draw_explorer:
    message:
        "Writing results/figures/explorer.html"
    input:
        data="results/figures/explorer.nc",
        texts=sorted(
            os.path.relpath(path)
            for path in Path(ROOT, "src/bouncing_ball/figures/explorer").iterdir()
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
