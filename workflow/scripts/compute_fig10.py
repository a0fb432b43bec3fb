"""Bouncing-off velocity along the frequency ratio."""

from bouncing_ball.paper.exhibits.apparent_restitution import frequency_sweep
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, frequency_sweep)
