"""The frequency ratio at which the period doubling of each family is lowest."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.lowest_period_doubling import lowest_period_doublings
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, lowest_doubling=lowest_period_doublings)
