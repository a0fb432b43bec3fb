"""Errors of both models on contacts with other laws."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.contact_laws import law_errors

with logged(snakemake):
    make_dataset(snakemake, law_errors)
