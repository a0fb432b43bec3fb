"""Figure 12."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.time_histories_figures import both_histories
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, both_histories)
