"""The table ext_proofs."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.tables import write_table
from bouncing_ball_beyond.exhibits.proofs_figures import ext_proofs

with job.logged(snakemake):
    write_table(snakemake, ext_proofs)
