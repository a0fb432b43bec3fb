"""Permanent contact: the amplitude from which on the table throws the ball off."""

from bouncing_ball.paper.exhibits.permanent_contact import (
    permanent_contact,
    permanent_contact_error,
)
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig11=permanent_contact, fig16=permanent_contact_error)
