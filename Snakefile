# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011), from the equations to the
# figures. `snakemake --cores 2` makes everything, `snakemake --cores 2 fig08`
# one figure, `snakemake --cores 1 accept` copies the results over the record.

from snakemake.utils import min_version

min_version("9.5")


configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
# Stages: parameters in, datasets out.
include: "workflow/rules/time_histories.smk"
include: "workflow/rules/restitution_orbits.smk"
include: "workflow/rules/apparent_restitution.smk"
include: "workflow/rules/continuation.smk"
include: "workflow/rules/frequency_sweeps.smk"
include: "workflow/rules/permanent_contact.smk"
include: "workflow/rules/error_thresholds.smk"
include: "workflow/rules/release_rules.smk"
include: "workflow/rules/witness.smk"
include: "workflow/rules/forensics.smk"
include: "workflow/rules/formulas.smk"
include: "workflow/rules/claims.smk"
# Renderings: datasets in, figures, tables and text out.
include: "workflow/rules/figures.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/paper.smk"


rule all:
    default_target: True
    message:
        "All figures, tables and the paper are up to date"
    input:
        figures=expand("results/figures/{figure}.{kind}", figure=FIGURES, kind=["png", "svg"]),
        tables=expand("results/figures/{table}.{kind}", table=TABLES, kind=["csv", "md", "tex"]),
        paper="results/paper.md",
        tally="results/tally.txt",
    log:
        "results/logs/all.log",
    shell:
        "tee {log} < {input.tally}"


localrules:
    all,


# The accepted record in git.
include: "workflow/rules/record.smk"
# The results against the record, and what the budgets of that come from.
include: "workflow/rules/diff.smk"
include: "workflow/rules/convergence.smk"
