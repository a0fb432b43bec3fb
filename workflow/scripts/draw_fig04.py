"""Figure 4."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.schematics_figures import spring_damper_model
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, spring_damper_model)
