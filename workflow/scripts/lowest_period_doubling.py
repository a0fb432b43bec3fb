"""The frequency ratio at which the period doubling of each family is lowest."""

from bouncing_ball.paper.exhibits.lowest_period_doubling import lowest_period_doublings
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, lowest_doubling=lowest_period_doublings)
