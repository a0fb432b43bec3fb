"""The table ext_laws."""

from bouncing_ball.pipeline.job import logged, write_table
from bouncing_ball_beyond.exhibits.contact_laws_figures import ext_laws

with logged(snakemake):
    write_table(snakemake, ext_laws)
