"""Figure 5."""

from bouncing_ball.paper.exhibits.apparent_restitution_figures import apparent_restitution
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, apparent_restitution)
