# Targets by name, `snakemake fig08`: whatever is published of it, the dataset too,
# which Snakemake would not miss beside a figure that is there.

for name in STAGES:

    rule:
        name:
            name
        localrule: True
        message:
            f"{name} is up to date"
        input:
            files([name]),
