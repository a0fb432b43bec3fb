"""The table ext_orders."""

from bouncing_ball_beyond.exhibits.corrected_model_figures import ext_orders
from bouncing_ball_beyond.inherited.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, ext_orders)
