"""The error thresholds."""

from bouncing_ball.pipeline.job import logged, write_table
from bouncing_ball.paper.exhibits.error_thresholds_figures import thresholds

with logged(snakemake):
    write_table(snakemake, thresholds)
