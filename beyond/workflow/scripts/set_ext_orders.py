"""The table ext_orders."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.tables import write_table
from bouncing_ball_beyond.exhibits.corrected_model_figures import ext_orders

with job.logged(snakemake):
    write_table(snakemake, ext_orders)
