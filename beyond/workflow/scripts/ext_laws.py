"""Errors of both models on contacts with other laws."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.contact_laws import law_errors

with job.logged(snakemake):
    make_datasets(snakemake, ext_laws=law_errors)
