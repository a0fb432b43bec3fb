# Carbonelli, Perret-Liaudet, Rigaud and Feki (2011), from the equations to the
# figures. `snakemake --cores 2` makes everything, `snakemake --cores 2 fig08`
# one figure, `snakemake --cores 1 accept` copies the results over the record.

from snakemake.utils import min_version

min_version("9.5")


configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
# Parameters in, datasets out.
include: "workflow/rules/stages.smk"
# Datasets in, figures, tables and text out.
include: "workflow/rules/figures.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/explorer.smk"
include: "workflow/rules/paper.smk"
# Each artifact by its name, with its dataset.
include: "workflow/rules/artifacts.smk"


rule all:
    default_target: True
    message:
        "All figures, tables and the paper are up to date"
    input:
        artifacts=files(STAGES),
        paper=rules.paper.output,
    log:
        "results/logs/all.log",
    shell:
        "tee {log} < results/tally.txt"


localrules:
    all,


# The accepted record in git, and the results against it.
include: "workflow/rules/record.smk"
# The error law, on more orbits than a run can take.
include: "workflow/rules/error_law.smk"
# The atlas of thresholds, on more orbits still.
include: "workflow/rules/atlas.smk"
