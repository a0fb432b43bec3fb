# From datasets to figures: each figure is made from the dataset with its name. The schematics have
# no dataset, and that of the atlas is accepted by hand.

DRAWINGS |= {"fig01": "paper.exhibits.schematics_figures.restitution_model", "fig04": "paper.exhibits.schematics_figures.spring_damper_model"}
DRAWINGS["ext_atlas"] = "beyond.atlas.figures.over_range"

CAPTIONS = [path.stem for path in Path(ROOT, "workflow/report").glob("*.rst")]

for name, drawing in DRAWINGS.items():

    rule:
        name:
            f"draw_{name}"
        message:
            f"Drawing {name}"
        input:
            data=[dataset(name)] if name in {*STUDIES, *ACCEPTED} else [],
            source=modules(drawing.rpartition(".")[0], "drawing.files"),
            settings=os.path.relpath(Path(ROOT, "src/bouncing_ball/drawing/matplotlibrc")),
        params:
            drawing=drawing,
        output:
            png=report(
                f"results/figures/{name}.png",
                caption=f"../report/{name if name in CAPTIONS else 'figure'}.rst",
                category="Figures" if name.startswith("fig") else "Beyond the paper",
                labels={"figure": name},
            ),
            svg=f"results/figures/{name}.svg",
        log:
            f"results/logs/figures/{name}.log",
        script:
            "../scripts/figure.py"


EXPLORER = os.path.relpath(HERE / "explorer")


# The page to explore the models, with reference orbits for the check of its results.
rule draw_explorer:
    message:
        "Writing results/figures/explorer.html"
    input:
        data="results/figures/explorer.nc",
        texts=sorted(map(str, Path(EXPLORER).glob("*.[chj]*"))),
        source=modules("paper.comparison.errors", "explorer.document", "explorer.engine_cases"),
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/explorer.log",
    script:
        "../scripts/explorer.py"
