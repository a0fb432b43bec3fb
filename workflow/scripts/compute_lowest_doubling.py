"""The frequency ratio at which the period doubling of each family is lowest."""

from bouncing_ball.paper.exhibits.lowest_period_doubling import lowest_period_doublings
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, lowest_period_doublings)
