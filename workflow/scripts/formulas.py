"""Printed formulas against a second computation."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies.formulas import formulas

make_dataset(snakemake, formulas)
