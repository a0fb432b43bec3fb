# Targets by name for each figure, table and dataset, and what `snakemake --list` says of them.

for name in [name for name in ENTRIES if name not in DRAWN]:

    rule:
        name:
            name
        localrule: True
        input:
            files(name),


# The text of a docstring cannot be a variable. As a module with a prefix, rules have other names.
for target in workflow.rules:
    target.docstring = target.docstring or listed(target.name)
