# From datasets to figures and tables. Each is made from the dataset of its
# artifact; the schematics have no dataset.

REPORT = Path(HOUSE, "report") if HOUSE != ROOT else Path(ROOT, "workflow/report")
TITLE = f"{ROOT}/workflow/report/title.rst"


def caption_of(artifact):
    caption = REPORT / f"{artifact.name}.rst"
    return str(caption) if caption.exists() else TITLE


# Below its picture the report has the caption NAME.rst of the house, or else the title.
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
                caption=caption_of(each),
                category="Figures",
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
                caption=TITLE,
                category="Tables",
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
