"""The table ext_verdicts."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.tables import write_table
from bouncing_ball_beyond.exhibits.certified_verdicts_figures import ext_verdicts

with job.logged(snakemake):
    write_table(snakemake, ext_verdicts)
