"""Restitution and duration of a free impact."""

from bouncing_ball_beyond.exhibits.release_rules import free_impacts
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, free_impacts)
