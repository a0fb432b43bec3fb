"""The table ext_orders."""

from bouncing_ball.pipeline.job import logged, write_table
from bouncing_ball_beyond.exhibits.corrected_model_figures import ext_orders

with logged(snakemake):
    write_table(snakemake, ext_orders)
