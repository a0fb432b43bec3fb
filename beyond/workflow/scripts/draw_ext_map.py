"""The figure ext_map."""

from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.stiffness_map_figures import stiffness_map

with logged(snakemake):
    draw(snakemake, stiffness_map)
