# Targets by name, for example `snakemake fig08`: all files of the artifact, including its dataset,
# because Snakemake would not make a missing dataset again while the figure exists.


def files(name):
    kinds = ["nc"] * (name in STUDIES and name not in ACCEPTED)
    kinds += ["png", "svg"] * (name in DRAWINGS) + ["csv", "md"] * (name in TABLES)
    kinds += ["html"] * (name == "explorer")
    return [f"results/figures/{name}.{kind}" for kind in kinds]


for name in {**STUDIES, **DRAWINGS}:

    rule:
        name:
            name
        localrule: True
        message:
            f"{name} is up to date"
        input:
            files(name),

    workflow.get_rule(name).docstring = TABLE.get(name, {}).get(
        "title", "A schematic, or a chart of the accepted atlas"
    )
