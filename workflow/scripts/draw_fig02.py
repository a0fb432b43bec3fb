"""Figure 2."""

from bouncing_ball.paper.exhibits.restitution_model_figures import restitution_history
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, restitution_history)
