"""The printed formulas against a second computation."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball.paper.claims.formulas import formulas

with logged(snakemake):
    make_dataset(snakemake, formulas)
