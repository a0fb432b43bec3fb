"""Figure 14."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.error_thresholds_figures import height_error
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, height_error)
