# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011): a ball that bounces on a vibrating table.
#
#     snakemake --cores 2                      everything, below results/
#     snakemake --cores 2 permanent_contact    the figures of one stage
#     snakemake --cores 2 fig14 table1         a figure and a table
#     snakemake --cores 2 diff                 compares the results with the reference
#     snakemake --cores 2 fig14 diff           makes and compares Figure 14 only
#     snakemake --cores 2 accept               makes the results the new reference

from snakemake.utils import min_version

min_version("9.5")


report: "workflow/report/workflow.rst"


include: "workflow/rules/configuration.smk"
include: "workflow/rules/common.smk"
include: "workflow/rules/stages.smk"
include: "workflow/rules/texts.smk"
include: "workflow/rules/reference.smk"
include: "workflow/rules/targets.smk"


rule all:
    """Figures, tables, claims and the article, and a page of them: results/index.html"""
    default_target: True
    localrule: True
    input:
        [files(name) for name in KINDS],
        rules.article.output,
        page=rules.article.output.index,
    log:
        "results/logs/all.log",
    conda:
        "workflow/envs/environment.yaml"
    shell:
        "echo Look at {input.page} | tee {log}"
