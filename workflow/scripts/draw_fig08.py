"""Figure 8."""

from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import domains
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, domains)
