"""The figure ext_map."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.stiffness_map_figures import stiffness_map

with job.logged(snakemake):
    draw(snakemake, stiffness_map)
