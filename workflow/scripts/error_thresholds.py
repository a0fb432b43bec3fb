"""Error thresholds: the frequency ratio from which on the restitution model is accurate."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.error_thresholds import error_thresholds
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, thresholds=error_thresholds)
