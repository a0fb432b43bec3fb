"""Figure 8."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import domains
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, domains)
