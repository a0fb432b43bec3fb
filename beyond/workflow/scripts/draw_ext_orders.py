"""The figure ext_orders."""

from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.corrected_model_figures import orders

with logged(snakemake):
    draw(snakemake, orders)
