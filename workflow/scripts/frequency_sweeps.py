"""Bouncing-off velocity and Poincaré map along the frequency ratio."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.apparent_restitution import frequency_sweep, poincare_map
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig10=frequency_sweep, fig13=poincare_map)
