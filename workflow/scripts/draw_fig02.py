"""Figure 2."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.restitution_model_figures import restitution_history
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, restitution_history)
