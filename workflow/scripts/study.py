"""One dataset by the study of its stage."""

from bouncing_ball.pipeline.jobs import make_dataset

make_dataset(snakemake)
