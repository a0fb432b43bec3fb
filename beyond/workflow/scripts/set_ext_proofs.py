"""The table ext_proofs."""

from bouncing_ball.pipeline.job import logged, write_table
from bouncing_ball_beyond.exhibits.proofs_figures import ext_proofs

with logged(snakemake):
    write_table(snakemake, ext_proofs)
