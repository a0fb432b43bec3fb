"""The figure ext_instant."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.corrected_model_figures import meeting_flights

with job.logged(snakemake):
    draw(snakemake, meeting_flights)
