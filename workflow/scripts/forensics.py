"""Table 1 under readings of what the authors may have done."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.claims.forensics import forensics
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, forensics=forensics)
