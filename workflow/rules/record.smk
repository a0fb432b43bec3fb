# The accepted record: figures/ and paper.md, which git holds, with accepted.csv,
# which says why it moved. Only this target writes there:
#     ONLY="fig08 | table1" REASON="… | …" snakemake --cores 1 accept
# It has no output and no benchmark, so that it looks at the record each time.

from bouncing_ball.record.recipe import planned


def request(wildcards):
    """No file: reason and groups of an acceptance are checked before anything is made."""
    # Imported here: no other target needs the record.
    from bouncing_ball.record.accept import groups

    try:
        groups(os.environ.get("ONLY", ""), os.environ.get("REASON", ""))
    except ValueError as error:
        sys.exit(f"accept: {error}")
    return []


rule accept:
    message:
        "Copying the results over the record in figures/ and paper.md"
    input:
        artifacts=rules.all.input.artifacts,
        paper=rules.paper.output.paper,
        request=request,
    params:
        record=ROOT,
        recipes=lambda wildcards: planned(workflow.dag),
    log:
        "results/logs/accept.log",
    script:
        "../scripts/accept.py"
