"""Bifurcations and thresholds under both release rules."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies.release_rules import release_rules

make_dataset(snakemake, release_rules)
