"""The error thresholds."""

from bouncing_ball.paper.exhibits.error_thresholds_figures import thresholds
from bouncing_ball.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, thresholds)
