"""Figure 6."""

from bouncing_ball.paper.exhibits.apparent_restitution_figures import apparent_restitution
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, apparent_restitution)
