"""The table ext_laws."""

from bouncing_ball_beyond.exhibits.contact_laws_figures import ext_laws
from bouncing_ball_beyond.inherited.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, ext_laws)
