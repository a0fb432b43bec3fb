"""Figure 13."""

from bouncing_ball.paper.exhibits.apparent_restitution_figures import poincare_map
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, poincare_map)
