"""Bouncing-off velocity along the frequency ratio."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball.paper.exhibits.apparent_restitution import frequency_sweep

with logged(snakemake):
    make_dataset(snakemake, frequency_sweep)
