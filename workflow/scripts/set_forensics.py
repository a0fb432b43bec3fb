"""The readings of Table 1."""

from bouncing_ball.paper.claims.claim_tables import forensics
from bouncing_ball.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, forensics)
