"""Apparent restitution along the frequency ratio."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.apparent_restitution import apparent_restitution
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig05=apparent_restitution, fig06=apparent_restitution)
