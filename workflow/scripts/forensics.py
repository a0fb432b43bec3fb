"""Table 1 under every reading."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies.forensics.study import forensics

make_dataset(snakemake, forensics)
