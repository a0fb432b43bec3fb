"""Apparent restitution along ϖ."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies.frequency_sweeps import apparent_restitution

make_dataset(snakemake, apparent_restitution, snakemake.params.release)
