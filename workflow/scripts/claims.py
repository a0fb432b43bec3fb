"""The verdicts on the paper's claims."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.claims.claims import claims
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, claims=claims)
