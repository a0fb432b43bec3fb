# The accepted results in git, figures/, article.md and appendix.md, are the reference. Only the rule `accept`
# writes to them. Both rules have no outputs, so that they run whenever they are named.


rule diff:
    """Compares the results with the reference: results/diff/index.html"""
    localrule: True
    input:
        results=requested_files,
        code=code("compare"),
    params:
        names=requested,
        artifacts=descriptions(),
        results=results_folder,
        reference=reference_folder,
        template=package("../../workflow/templates/diff.html.j2"),
    log:
        "results/logs/diff.log",
    conda:
        ENVIRONMENT
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
        artifacts=descriptions(),
        results=results_folder,
        reference=reference_folder,
        # The reference is that of the configuration in git.
        config=config,
        accepted=yaml_of(PACKAGE / "config/config.yaml"),
    log:
        "results/logs/accept.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/accept.py"


# If a figure fails, the page of an earlier comparison would be taken for that of this run.
onstart:
    shell("rm -rf results/diff")
