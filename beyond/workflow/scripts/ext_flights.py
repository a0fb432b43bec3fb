"""Flights in a period above the threshold of permanent contact."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.cascade_of_flights import cascade_of_flights

with job.logged(snakemake):
    make_datasets(snakemake, ext_flights=cascade_of_flights)
