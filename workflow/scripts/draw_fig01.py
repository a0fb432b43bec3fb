"""Figure 1."""

from bouncing_ball.paper.exhibits.schematics_figures import restitution_model
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, restitution_model)
