"""Orbits with which the page of the explorer compares its results."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.explorer_orbits import reference_orbits

with job.logged(snakemake):
    make_datasets(snakemake, explorer=reference_orbits)
