"""Existence and stability of n-T orbits of the spring-damper model, by continuation."""

from bouncing_ball.paper.exhibits.continuation_of_orbits import orbit_branches
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig08=orbit_branches, fig09=orbit_branches)
