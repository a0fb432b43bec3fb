"""A periodic, a subharmonic and a chaotic motion of the restitution model."""

from bouncing_ball.paper.exhibits.kinds_of_motion import kinds_of_motion
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, three_balls=kinds_of_motion)
