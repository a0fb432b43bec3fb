# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011), from the equations to the figures.
# `snakemake --cores 2` makes all figures, tables and texts, `snakemake --cores 2 permanent_contact` a
# stage, `snakemake --cores 2 fig08` one figure, `snakemake --cores 2 diff` compares the results with
# the record, and `snakemake --cores 1 accept` copies them over it.

from snakemake.utils import min_version

min_version("9.5")

from bouncing_ball.paper.artifacts import ARTIFACTS
from bouncing_ball.paper.exhibits.budgets import BUDGETS


include: "workflow/rules/common.smk"


configfile: here("config/config.yaml")


if workflow.is_main_process:
    from bouncing_ball.paper.configuration import Configuration

    check(Configuration)


# The first page of `snakemake --report`; `make report`.
report: "workflow/report/workflow.rst"


# From parameters to datasets, from datasets to figures and tables, and from these to the article.
include: "workflow/rules/datasets.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/article.smk"
# A target for each stage.
include: "workflow/rules/targets.smk"


rule all:
    """Figures 1 to 16, Table 1, the thresholds, the claims and the article."""
    default_target: True
    localrule: True
    input:
        rules.schematics.input,
        rules.restitution_model.input,
        rules.apparent_restitution.input,
        rules.time_histories.input,
        rules.continuation_of_orbits.input,
        rules.permanent_contact.input,
        rules.error_thresholds.input,
        rules.lowest_doubling.input,
        rules.three_balls.input,
        rules.formulas.input,
        rules.forensics.input,
        rules.witness.input,
        rules.claims.input,
        rules.paper.output,


rule replication:
    """Another name of `all`."""
    localrule: True
    input:
        rules.all.input,


# The accepted record in git, and the comparison of the results with it; and pages made from it.
include: "workflow/rules/record.smk"
include: "workflow/rules/written.smk"


# `snakemake --list` shows the message of a rule without a docstring.
for each in workflow.rules:
    each.docstring = each.docstring or each.message
