"""The threshold of permanent contact of both models, and its error."""

from bouncing_ball.paper.exhibits.permanent_contact import permanent_contact_error
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, permanent_contact_error)
