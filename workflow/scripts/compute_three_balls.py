"""A periodic, a subharmonic and a chaotic motion of the restitution model."""

from bouncing_ball.paper.exhibits.kinds_of_motion import kinds_of_motion
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, kinds_of_motion)
