"""The comparison of the three routes."""

from bouncing_ball.paper.claims.claim_tables import witness
from bouncing_ball.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, witness)
