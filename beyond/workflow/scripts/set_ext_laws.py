"""The table ext_laws."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.tables import write_table
from bouncing_ball_beyond.exhibits.contact_laws_figures import ext_laws

with job.logged(snakemake):
    write_table(snakemake, ext_laws)
