"""The printed formulas against a second computation."""

from bouncing_ball.paper.claims.formulas import formulas
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, formulas)
