"""Time histories of both models."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball.paper.exhibits.time_histories import both_histories

with logged(snakemake):
    make_dataset(snakemake, both_histories)
