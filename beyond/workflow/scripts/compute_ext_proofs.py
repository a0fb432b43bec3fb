"""Numbers of the paper with intervals that certainly contain them."""

from bouncing_ball.pipeline.job import logged, make_dataset
from bouncing_ball_beyond.exhibits.proofs import proofs

with logged(snakemake):
    make_dataset(snakemake, proofs)
