"""Numbers of the paper with intervals that certainly contain them."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.proofs import proofs

with job.logged(snakemake):
    make_datasets(snakemake, ext_proofs=proofs)
