"""Figure 12."""

from bouncing_ball.paper.exhibits.time_histories_figures import both_histories
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, both_histories)
