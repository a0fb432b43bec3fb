# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011), from the equations to the figures.
# `snakemake --cores 2` makes all figures, tables and texts, `snakemake --cores 2 replication` the paper alone,
# `snakemake --cores 2 permanent_contact` a stage, `snakemake --cores 2 fig08` one figure, `snakemake --cores 1 accept` copies the results over the
# record.

from snakemake.utils import min_version

min_version("9.5")


include: "workflow/rules/common.smk"
# Snakemake reads the configuration next, and a file that is no text of YAML would give a traceback.
include: "workflow/rules/readable.smk"


configfile: here("config/config.yaml")


# The first page of `snakemake --report`; `make report`.
report: "workflow/report/workflow.rst"


# From parameters to datasets: what all stages have in common, and the stages of the
# studies, with the study, the drawing and the table of each artifact.
include: "workflow/rules/stage.smk"
include: "workflow/rules/paper.smk"
include: "workflow/rules/check.smk"
# From datasets to figures and tables.
include: "workflow/rules/shown.smk"
# From datasets and tables to the article.
include: "workflow/rules/article.smk"
# A target for each artifact and each stage, with its name.
include: "workflow/rules/targets.smk"


rule all:
    default_target: True
    localrule: True
    message:
        "All figures, tables and the paper are up to date"
    input:
        artifacts=sorted(file for each in TARGETS for file in each.files),
        paper=rules.paper.output,
        tally=rules.set_claims.output.tally,
    log:
        "results/logs/all.log",
    conda:
        ENVIRONMENT
    shell:
        "tee {log} < results/tally.txt"


rule replication:
    """The paper alone: Figures 1 to 16, Table 1, the thresholds, the claims and the article."""
    localrule: True
    message:
        "The figures, tables and claims of the paper and its article are up to date"
    input:
        [file for each in TARGETS for file in each.files],
        rules.paper.output,


# The accepted record in git, and the comparison of the results with it.
include: "workflow/rules/record.smk"


# `snakemake --list` shows the message of a rule without a docstring.
for each in workflow.rules:
    each.docstring = each.docstring or each.message
