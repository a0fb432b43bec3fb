"""The threshold of permanent contact along the frequency ratio."""

from bouncing_ball.paper.exhibits.permanent_contact import permanent_contact
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, permanent_contact)
