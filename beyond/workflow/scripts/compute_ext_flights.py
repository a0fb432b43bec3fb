"""Flights in a period above the threshold of permanent contact."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.cascade_of_flights import cascade_of_flights

with logged(snakemake):
    make_dataset(snakemake, cascade_of_flights)
