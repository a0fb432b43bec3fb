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


# By the name of each stage its files, also the samples of motions, which take some minutes each.
STAGES = {}
for each in TARGETS:
    if each.study or not each.accepted:
        files = STAGES.setdefault(each.stage, [])
        files += [file for file in (each.computed, *each.files) if file and file not in files]

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
