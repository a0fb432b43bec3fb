"""Evidence for statements, from the datasets of the job."""

from pathlib import Path

from bouncing_ball.audit.evidence import evidence
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.pipeline.job import make_dataset


def study(parameters):
    """The evidence, on the datasets of the job."""
    paths = map(Path, snakemake.input.data)
    return evidence({path.stem: read_dataset(path) for path in paths}, parameters)


make_dataset(snakemake, study)
