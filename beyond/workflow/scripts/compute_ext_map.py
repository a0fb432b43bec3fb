"""How stiff a contact must be for the greatest height, over all stable orbits."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.stiffness_map import stiffness_map

with logged(snakemake):
    make_dataset(snakemake, stiffness_map)
