# From datasets to figures and tables. Each is made from the dataset of its
# artifact; the schematics have no dataset.

CAPTIONS = [path.stem for path in Path(ROOT, "workflow/report").glob("*.rst")]

# Below its picture the report has the caption `workflow/report/NAME.rst`, or else the title.
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
                data=[each.dataset],
            ),
            data=[each.dataset] if each.dataset else [],
        params:
            title=each.title,
            figures=each.figures,
            drawing=each.drawing,
        output:
            png=report(
                f"results/{each.place}.png",
                caption=f"../report/{each.name if each.name in CAPTIONS else 'title'}.rst",
                category="Figures" if each.part == "paper" else "Beyond the paper",
                labels={"figure": each.name},
            ),
            svg=f"results/{each.place}.svg",
        log:
            f"results/logs/figures/{each.name}.log",
        conda:
            ENVIRONMENT
        script:
            "../scripts/figure.py"


# A table as CSV and in Markdown. The page of the claims is a text with a table.
for each in ARTIFACTS.values():
    if not each.table or each.name == "claims":
        continue

    rule:
        name:
            f"set_{each.name}"
        message:
            f"Setting {each.name}"
        input:
            code=lambda wildcards, each=each: code(
                f"set_{each.name}",
                "table.py",
                each.figures,
                data=[each.dataset],
            ),
            data=each.dataset,
        output:
            csv=report(
                f"results/{each.place}.csv",
                caption="../report/title.rst",
                category="Tables" if each.part == "paper" else "Beyond the paper",
                labels={"table": each.name},
            ),
            md=f"results/{each.place}.md",
        params:
            title=each.title,
            figures=each.figures,
            table=each.table,
        log:
            f"results/logs/tables/{each.name}.log",
        conda:
            ENVIRONMENT
        script:
            "../scripts/table.py"
