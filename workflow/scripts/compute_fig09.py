"""n-T orbits of the spring-damper model of the second family, by continuation."""

from bouncing_ball.paper.exhibits.continuation_of_orbits import orbit_branches
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, orbit_branches)
