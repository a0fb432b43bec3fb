"""The figure ext_flights."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.cascade_of_flights_figures import cascade_of_flights

with job.logged(snakemake):
    draw(snakemake, cascade_of_flights)
