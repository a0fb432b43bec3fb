"""Printed formulas against a second computation."""

from bouncing_ball.audit.formulas import formulas
from bouncing_ball.pipeline.job import make_dataset

make_dataset(snakemake, formulas)
