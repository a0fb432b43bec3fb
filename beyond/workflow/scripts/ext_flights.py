"""Flights in a period above the threshold of permanent contact."""

from bouncing_ball.pipeline.job import logged, make_datasets
from bouncing_ball_beyond.exhibits.cascade_of_flights import cascade_of_flights

with logged(snakemake):
    make_datasets(snakemake, ext_flights=cascade_of_flights)
