"""Orbits with which the page of the explorer compares its results."""

from bouncing_ball_beyond.exhibits.explorer_orbits import reference_orbits
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, reference_orbits)
