"""The figure ext_orders."""

from bouncing_ball_beyond.exhibits.corrected_model_figures import orders
from bouncing_ball_beyond.inherited.pipeline.job import logged
from bouncing_ball_beyond.inherited.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, orders)
