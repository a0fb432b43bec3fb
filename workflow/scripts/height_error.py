"""The frequency ratio from which on the restitution model has the right greatest height."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.error_thresholds import height_error
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig14=height_error)
