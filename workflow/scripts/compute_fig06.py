"""Apparent restitution along the frequency ratio, by amplitude."""

from bouncing_ball.paper.exhibits.apparent_restitution import apparent_restitution
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, apparent_restitution)
