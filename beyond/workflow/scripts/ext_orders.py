"""How fast the errors of both models fall along the frequency ratio."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.corrected_model import orders

with job.logged(snakemake):
    make_datasets(snakemake, ext_orders=orders)
