"""Figure 10."""

from bouncing_ball.paper.exhibits.apparent_restitution_figures import bounce_velocity
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, bounce_velocity)
