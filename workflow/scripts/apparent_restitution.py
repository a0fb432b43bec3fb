"""Apparent restitution along the frequency ratio."""

from bouncing_ball.paper.exhibits.apparent_restitution import apparent_restitution
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig05=apparent_restitution, fig06=apparent_restitution)
