"""The frequency ratio from which on the restitution model has the right greatest height."""

from bouncing_ball.paper.exhibits.error_thresholds import height_error
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig14=height_error)
