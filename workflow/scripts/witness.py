"""Three routes to every published orbit."""

from pathlib import Path

from bouncing_ball.audit.cross_check import witness
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.pipeline.job import make_dataset


def study(settings):
    """The comparisons, on the datasets of the job."""
    paths = map(Path, snakemake.input.data)
    return witness({path.stem: read_dataset(path) for path in paths}, settings)


make_dataset(snakemake, study)
