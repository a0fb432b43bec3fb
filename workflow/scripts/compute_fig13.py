"""The Poincaré map of both models along the frequency ratio."""

from bouncing_ball.paper.exhibits.apparent_restitution import poincare_map
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, poincare_map)
