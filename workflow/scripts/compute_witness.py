"""Every orbit shown by three routes: continuation, formula and simulation."""

from bouncing_ball.paper.claims.witness import witness
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, witness)
