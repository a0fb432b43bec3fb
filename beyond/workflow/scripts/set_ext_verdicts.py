"""The table ext_verdicts."""

from bouncing_ball.pipeline.job import logged, write_table
from bouncing_ball_beyond.exhibits.certified_verdicts_figures import ext_verdicts

with logged(snakemake):
    write_table(snakemake, ext_verdicts)
