"""The figure ext_flights."""

from bouncing_ball_beyond.exhibits.cascade_of_flights_figures import cascade_of_flights
from bouncing_ball_beyond.inherited.pipeline.job import logged
from bouncing_ball_beyond.inherited.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, cascade_of_flights)
