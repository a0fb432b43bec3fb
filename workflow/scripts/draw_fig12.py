"""Figure 12."""

from bouncing_ball.paper.exhibits.time_histories_figures import both_histories
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, both_histories)
