"""Existence and stability of n-T orbits of both models, by continuation."""

from bouncing_ball.paper.exhibits.continuation_of_orbits import both_domains
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, both_domains)
