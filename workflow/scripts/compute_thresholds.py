"""Error thresholds: the frequency ratio from which on the restitution model is accurate."""

from bouncing_ball.paper.exhibits.error_thresholds import error_thresholds
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, error_thresholds)
