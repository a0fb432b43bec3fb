"""Restitution and duration of a free impact."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.release_rules import free_impacts

with logged(snakemake):
    make_dataset(snakemake, free_impacts)
