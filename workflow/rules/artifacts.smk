# Targets by name, `snakemake fig08`: whatever is published of it, the dataset too, which
# Snakemake would not miss beside a figure that is there.


def files(artifacts):
    kinds = {
        "nc": STUDIES,
        "png": DRAWINGS,
        "svg": DRAWINGS,
        **dict.fromkeys(["csv", "md", "tex"], TABLES),
        "html": ["explorer"],
    }
    return [
        f"results/figures/{name}.{kind}"
        for name in artifacts
        for kind, names in kinds.items()
        if name in names
    ]


ARTIFACTS = sorted({*STUDIES, *DRAWINGS})

for name in ARTIFACTS:

    rule:
        name:
            name
        localrule: True
        message:
            f"{name} is up to date"
        input:
            files([name]),
