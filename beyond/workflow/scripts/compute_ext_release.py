"""Bifurcations and thresholds under both release rules."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.release_rules import release_rules

with logged(snakemake):
    make_dataset(snakemake, release_rules)
