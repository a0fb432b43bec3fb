"""Figure 10."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.apparent_restitution_figures import bounce_velocity
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, bounce_velocity)
