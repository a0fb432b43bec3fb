"""Every orbit shown by three routes: continuation, formula and simulation."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.claims.witness import witness
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, witness=witness)
