"""Permanent contact: the amplitude from which on the table throws the ball off."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.permanent_contact import (
    permanent_contact,
    permanent_contact_error,
)
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig11=permanent_contact, fig16=permanent_contact_error)
