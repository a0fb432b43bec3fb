"""The verdicts on the paper's claims."""

from bouncing_ball.paper.claims.claims import claims
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, claims)
