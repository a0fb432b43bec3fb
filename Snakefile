# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011), from the equations to the figures.
# `snakemake --cores 2` makes everything, `snakemake --cores 2 fig08` one figure,
# `snakemake --cores 1 accept` copies the results over the record.

from snakemake.utils import min_version

min_version("9.5")


configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
# The stages of the paper with their names, figures and tables: from parameters to datasets.
include: "workflow/rules/study.smk"
include: "workflow/rules/check.smk"
# From datasets to figures, tables and text.
include: "workflow/rules/figures.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/article.smk"
# A target for each artifact, with its name, that includes the dataset.
include: "workflow/rules/artifacts.smk"


rule all:
    default_target: True
    localrule: True
    message:
        "All figures, tables and the paper are up to date"
    input:
        artifacts=[files(name) for name in sorted({*STUDIES, *DRAWINGS})],
        paper=rules.paper.output,
    log:
        "results/logs/all.log",
    shell:
        "tee {log} < results/tally.txt"


# The accepted record in git, and the comparison of the results with it.
include: "workflow/rules/record.smk"
# The atlas: how stiff is stiff enough, for more orbits than a run can include.
include: "workflow/rules/atlas.smk"


# `snakemake --list` shows the message of a rule without a docstring.
for each in workflow.rules:
    each.docstring = each.docstring or each.message
