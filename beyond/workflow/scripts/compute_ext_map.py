"""How stiff a contact must be for the greatest height, over all stable orbits."""

from bouncing_ball_beyond.exhibits.stiffness_map import stiffness_map
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, stiffness_map)
