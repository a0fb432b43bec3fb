"""Restitution and duration of a free impact."""

from bouncing_ball.pipeline.job import logged, make_datasets
from bouncing_ball_beyond.exhibits.release_rules import free_impacts

with logged(snakemake):
    make_datasets(snakemake, ext_impact=free_impacts)
