"""The comparison of the three routes."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.claims.tables import witness
from bouncing_ball.pipeline.tables import write_table

with job.logged(snakemake):
    write_table(snakemake, witness)
