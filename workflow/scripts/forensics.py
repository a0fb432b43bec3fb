"""Table 1 under every reading."""

from bouncing_ball.audit.forensics.study import forensics
from bouncing_ball.pipeline.job import make_dataset

make_dataset(snakemake, forensics)
