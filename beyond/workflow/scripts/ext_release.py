"""Bifurcations and thresholds under both release rules."""

from bouncing_ball.pipeline.job import logged, make_datasets
from bouncing_ball_beyond.exhibits.release_rules import release_rules

with logged(snakemake):
    make_datasets(snakemake, ext_release=release_rules)
