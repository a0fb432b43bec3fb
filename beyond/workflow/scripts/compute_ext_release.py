"""Bifurcations and thresholds under both release rules."""

from bouncing_ball_beyond.exhibits.release_rules import release_rules
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, release_rules)
