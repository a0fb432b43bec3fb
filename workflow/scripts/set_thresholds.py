"""The error thresholds."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.error_thresholds_figures import thresholds
from bouncing_ball.pipeline.tables import write_table

with job.logged(snakemake):
    write_table(snakemake, thresholds)
