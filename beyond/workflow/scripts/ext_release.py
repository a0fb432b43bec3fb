"""Bifurcations and thresholds under both release rules."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.release_rules import release_rules

with job.logged(snakemake):
    make_datasets(snakemake, ext_release=release_rules)
