# The accepted results in git, figures/, paper.md and supplement.md, are the reference. Only the rule
# `accept` writes to them. Both rules have no outputs, so that they run whenever they are named.


def requested(wildcards):
    """The figures and tables that the command line names together with `diff` or `accept`."""
    targets = workflow.dag_settings.targets
    names = [name for stage in STAGES if stage in targets for name in STAGES[stage]]
    return sorted({*names, *(name for name in ARTIFACTS if name in targets)}) or ARTIFACTS


def requested_files(wildcards):
    """The files to compare: those of the figures and tables named, or everything."""
    if requested(wildcards) == ARTIFACTS:
        return rules.all.input
    return [file for name in requested(wildcards) for file in files(name)]


def description(name):
    """The parameters and the code from which a figure or table is made."""
    stage = next((stage for stage in STAGES if name in STAGES[stage]), None)
    parameters = {}
    if stage:
        settings = {key: config[key] for key in SETTINGS[stage]}
        parameters = {**config[stage].get(name, {}), **settings}
    return {"parameters": parameters, "code": code(stage or "draw")}


rule diff:
    """Compares the results with the reference: results/diff/index.html"""
    localrule: True
    input:
        results=requested_files,
        code=code("compare"),
    params:
        names=requested,
        artifacts={name: description(name) for name in ARTIFACTS},
        reference=checkout("."),
    log:
        "results/logs/diff.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/compare.py"


rule accept:
    """Makes the results the new reference"""
    localrule: True
    input:
        results=requested_files,
        code=code("accept"),
    params:
        names=requested,
        artifacts={name: description(name) for name in ARTIFACTS},
        reference=checkout("."),
    log:
        "results/logs/accept.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/accept.py"
