"""The printed formulas against a second computation."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.claims.formulas import formulas
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, formulas=formulas)
