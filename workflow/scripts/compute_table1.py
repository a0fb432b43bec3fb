"""The ranges of Table 1, by continuation."""

from bouncing_ball.paper.exhibits.continuation_of_orbits import stability_ranges
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, stability_ranges)
