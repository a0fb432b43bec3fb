"""The error thresholds."""

from bouncing_ball.paper.exhibits.error_thresholds_figures import thresholds
from bouncing_ball.pipeline.figures_and_tables import write_table
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    write_table(snakemake, thresholds)
