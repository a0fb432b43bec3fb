"""How stiff a contact must be for the greatest height, over all stable orbits."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.stiffness_map import stiffness_map

with job.logged(snakemake):
    make_datasets(snakemake, ext_map=stiffness_map)
