"""Figure 1."""

from bouncing_ball.paper.exhibits.schematics_figures import restitution_model
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, restitution_model)
