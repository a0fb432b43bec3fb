"""Errors of both models on contacts with other laws."""

from bouncing_ball_beyond.exhibits.contact_laws import law_errors
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, law_errors)
