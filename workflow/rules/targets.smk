# Targets by name for each figure, table and dataset, and what `snakemake --list` says of them.

NAMED = [rule.name for rule in workflow.rules]

for name in [name for name in ENTRIES if name not in NAMED]:

    # It is always executed, and so it says where the files are also if they were there already.
    rule:
        name:
            name
        localrule: True
        input:
            files(name),
        params:
            title=ENTRIES[name]["title"],
        log:
            f"results/logs/target_{name}.log",
        conda:
            "../envs/environment.yaml"
        shell:
            "echo {params.title:q}: {input} | tee {log}"


if not is_module:

    rule unknown:
        """Any other name: says which names are near it"""
        output:
            "{name}",
        wildcard_constraints:
            name=r"[^/.]+",
        input:
            unknown_target,


# The text of a docstring cannot be a variable. As a module with a prefix, rules have other names.
for target in workflow.rules:
    target.docstring = target.docstring or listed(target.name)
