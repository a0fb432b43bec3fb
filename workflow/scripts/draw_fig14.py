"""Figure 14."""

from bouncing_ball.paper.exhibits.error_thresholds_figures import height_error
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, height_error)
