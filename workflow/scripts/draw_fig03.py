"""Figure 3."""

from bouncing_ball.paper.exhibits.restitution_model_figures import restitution_families
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, restitution_families)
