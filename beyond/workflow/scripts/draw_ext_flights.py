"""The figure ext_flights."""

from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.cascade_of_flights_figures import cascade_of_flights

with logged(snakemake):
    draw(snakemake, cascade_of_flights)
