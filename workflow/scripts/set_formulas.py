"""The check of the printed formulas."""

from bouncing_ball.paper.claims.claim_tables import formulas
from bouncing_ball.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, formulas)
