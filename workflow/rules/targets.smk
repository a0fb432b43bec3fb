# Targets by name, for example `snakemake fig08`: all files of the artifact, including its dataset,
# because Snakemake would not make a missing dataset again while the figure exists.

TARGETS = [each for each in ARTIFACTS.values() if each.study or each.drawing]

for each in TARGETS:

    rule:
        name:
            each.name
        localrule: True
        message:
            f"{each.name} is up to date"
        input:
            each.files,

    workflow.get_rule(each.name).docstring = each.title
