# Targets by name, `snakemake fig08`: whatever is published of it, the dataset too, which
# Snakemake would not miss beside a figure that is there.


def files(name):
    kinds = ["nc"] * (name in STUDIES) + ["png", "svg"] * (name in DRAWINGS)
    kinds += ["csv", "md"] * (name in TABLES) + ["html"] * (name == "explorer")
    return [f"results/figures/{name}.{kind}" for kind in kinds]


ARTIFACTS = sorted({*STUDIES, *DRAWINGS})

for name in ARTIFACTS:

    rule:
        name:
            name
        localrule: True
        message:
            f"{name} is up to date"
        input:
            files(name),
