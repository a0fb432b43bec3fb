"""Table 1 under readings of what the authors may have done."""

from bouncing_ball.paper.claims.forensics import forensics
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, forensics)
