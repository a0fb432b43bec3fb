"""The figure ext_instant."""

from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.corrected_model_figures import meeting_flights

with logged(snakemake):
    draw(snakemake, meeting_flights)
