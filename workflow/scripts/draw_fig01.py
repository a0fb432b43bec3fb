"""Figure 1."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.schematics_figures import restitution_model
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, restitution_model)
