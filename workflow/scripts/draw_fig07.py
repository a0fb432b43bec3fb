"""Figure 7."""

from bouncing_ball.paper.exhibits.time_histories_figures import contact_history
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, contact_history)
