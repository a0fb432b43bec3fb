"""Figure 6."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.apparent_restitution_figures import apparent_restitution
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, apparent_restitution)
