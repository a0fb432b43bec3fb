"""The verdicts on the paper's claims."""

from bouncing_ball.paper.claims.claims import claims
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, claims=claims)
