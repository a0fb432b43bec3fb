"""The figure ext_map."""

from bouncing_ball_beyond.exhibits.stiffness_map_figures import stiffness_map
from bouncing_ball_beyond.inherited.pipeline.job import logged
from bouncing_ball_beyond.inherited.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, stiffness_map)
