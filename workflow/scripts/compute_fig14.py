"""The frequency ratio from which on the restitution model has the right greatest height."""

from bouncing_ball.paper.exhibits.error_thresholds import height_error
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, height_error)
