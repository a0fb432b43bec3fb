"""Existence and stability of n-T orbits of both models, by continuation."""

from bouncing_ball.paper.exhibits.continuation_of_orbits import both_domains
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig15=both_domains)
