"""Figure 2."""

from bouncing_ball.paper.exhibits.restitution_model_figures import restitution_history
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, restitution_history)
