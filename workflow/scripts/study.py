"""One dataset by the study of its stage."""

from bouncing_ball.pipeline.job import make_dataset

make_dataset(snakemake)
