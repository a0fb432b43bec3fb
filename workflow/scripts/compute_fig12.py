"""Time histories of both models."""

from bouncing_ball.paper.exhibits.time_histories import both_histories
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, both_histories)
