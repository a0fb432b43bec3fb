"""Table 1."""

from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import table1
from bouncing_ball.pipeline.figures_and_tables import write_table
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    write_table(snakemake, table1)
