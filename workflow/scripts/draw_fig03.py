"""Figure 3."""

from bouncing_ball.paper.exhibits.restitution_model_figures import restitution_families
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, restitution_families)
