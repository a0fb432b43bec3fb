"""Orbits with which the page of the explorer compares its results."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.explorer_orbits import reference_orbits

with logged(snakemake):
    make_dataset(snakemake, reference_orbits)
