"""The figure ext_instant."""

from bouncing_ball_beyond.exhibits.corrected_model_figures import meeting_flights
from bouncing_ball_beyond.inherited.pipeline.job import logged
from bouncing_ball_beyond.inherited.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, meeting_flights)
