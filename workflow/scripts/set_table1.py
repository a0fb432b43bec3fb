"""Table 1."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import table1
from bouncing_ball.pipeline.tables import write_table

with job.logged(snakemake):
    write_table(snakemake, table1)
