"""Flights in a period above the threshold of permanent contact."""

from bouncing_ball_beyond.exhibits.cascade_of_flights import cascade_of_flights
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, cascade_of_flights)
