"""Figure 13."""

from bouncing_ball.paper.exhibits.apparent_restitution_figures import poincare_map
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, poincare_map)
