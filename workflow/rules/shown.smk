# From datasets to figures, tables and the page of the explorer. Each is made from the dataset of its
# artifact; the schematics have no dataset.

CAPTIONS = [path.stem for path in Path(ROOT, "workflow/report").glob("*.rst")]

for each in ARTIFACTS.values():
    if not each.drawing:
        continue

    rule:
        name:
            f"draw_{each.name}"
        message:
            f"Drawing {each.name}"
        input:
            code=lambda wildcards, each=each: code(
                f"draw_{each.name}",
                "figure.py",
                each.figures,
            ),
            data=[each.dataset] if each.dataset else [],
        params:
            figures=each.figures,
            drawing=each.drawing,
        output:
            png=report(
                f"results/figures/{each.name}.png",
                caption=f"../report/{each.name if each.name in CAPTIONS else 'figure'}.rst",
                category="Figures" if each.part == "paper" else "Beyond the paper",
                labels={"figure": each.name},
            ),
            svg=f"results/figures/{each.name}.svg",
        log:
            f"results/logs/figures/{each.name}.log",
        script:
            "../scripts/figure.py"


TABLES = [each.name for each in ARTIFACTS.values() if each.table]


rule set_table:
    """A table as CSV and in Markdown."""
    message:
        "Setting {wildcards.table}"
    input:
        code=lambda w: code(
            f"set_{w.table}",
            "table.py",
            ARTIFACTS[w.table].figures,
        ),
        data="results/figures/{table}.nc",
    output:
        csv="results/figures/{table}.csv",
        md="results/figures/{table}.md",
    params:
        figures=lambda w: ARTIFACTS[w.table].figures,
        table=lambda w: ARTIFACTS[w.table].table,
    wildcard_constraints:
        # The page of the claims is a text with a table.
        table="|".join(name for name in TABLES if name != "claims"),
    log:
        "results/logs/tables/{table}.log",
    script:
        "../scripts/table.py"


# The page to explore the models, with reference orbits for the check of its results.
rule draw_explorer:
    message:
        "Writing results/figures/explorer.html"
    input:
        code=lambda wildcards: code("draw_explorer", "explorer.py"),
        data="results/figures/explorer.nc",
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/explorer.log",
    script:
        "../scripts/explorer.py"
