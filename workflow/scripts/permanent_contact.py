"""Permanent contact threshold along ϖ."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies.permanent_contact_curve import permanent_contact

make_dataset(snakemake, permanent_contact, snakemake.params.release)
