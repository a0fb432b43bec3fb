"""The ranges of Table 1, by continuation."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.continuation_of_orbits import stability_ranges
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, table1=stability_ranges)
