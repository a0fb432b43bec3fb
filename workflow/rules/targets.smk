# Targets by name: `snakemake fig08` makes all files of an artifact, including its dataset, because
# Snakemake would not make a missing dataset again while the figure exists; and
# `snakemake permanent_contact` all artifacts of a stage.

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


# By the name of each stage its files.
STAGES = {}
for each in TARGETS:
    if not each.accepted:
        files = STAGES.setdefault(each.stage, [])
        files += each.files

for name, files in STAGES.items():
    # The only artifact of its stage may have the name of the stage.
    if name in ARTIFACTS:
        continue

    rule:
        name:
            name
        localrule: True
        message:
            f"{name} is up to date"
        input:
            files,

    if workflow.is_rule(f"{name}_study"):
        workflow.get_rule(name).docstring = workflow.get_rule(f"{name}_study").docstring
