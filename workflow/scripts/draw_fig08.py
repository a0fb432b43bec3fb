"""Figure 8."""

from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import domains
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, domains)
