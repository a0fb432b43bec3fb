"""Existence and stability of n-T orbits of both models, by continuation."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.continuation_of_orbits import both_domains
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig15=both_domains)
