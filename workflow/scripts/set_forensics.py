"""The readings of Table 1."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.claims.tables import forensics
from bouncing_ball.pipeline.tables import write_table

with job.logged(snakemake):
    write_table(snakemake, forensics)
