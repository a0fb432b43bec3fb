"""Orbits along ϖ."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies.frequency_sweeps import frequency_sweep

make_dataset(snakemake, frequency_sweep, snakemake.params.release)
