"""A periodic, a subharmonic and a chaotic motion of the restitution model."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.kinds_of_motion import kinds_of_motion
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, three_balls=kinds_of_motion)
