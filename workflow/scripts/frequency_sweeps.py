"""Bouncing-off velocity and Poincaré map along the frequency ratio."""

from bouncing_ball.paper.exhibits.apparent_restitution import frequency_sweep, poincare_map
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig10=frequency_sweep, fig13=poincare_map)
