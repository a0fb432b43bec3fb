"""Restitution and duration of a free impact."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.release_rules import free_impacts

with job.logged(snakemake):
    make_datasets(snakemake, ext_impact=free_impacts)
