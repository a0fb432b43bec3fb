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
        config=config,
        results=results_folder,
        reference=reference_folder,
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
        results=results_folder,
        reference=reference_folder,
        # The reference is that of the configuration in git; other results are stale.
        config=yaml_of(PACKAGE / "config/config.yaml"),
    log:
        "results/logs/accept.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/accept.py"


# If a figure fails, the page and the log of an earlier comparison would be taken for this run's.
onstart:
    for path in ("results/diff/index.html", "results/logs/diff.log"):
        Path(path).unlink(missing_ok=True)
