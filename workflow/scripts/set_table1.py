"""Table 1."""

from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import table1
from bouncing_ball.pipeline.job import logged, write_table

with logged(snakemake):
    write_table(snakemake, table1)
