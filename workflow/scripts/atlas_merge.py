"""The atlas from its shards."""

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.shards import merge
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.atlas import log_of
from bouncing_ball.pipeline.job import logged, publish, read_input


def read(path):
    return read_input(path, log_of(path))


with logged(snakemake):
    parameters = snakemake.params.parameters
    *shards, limits = snakemake.input.parts
    dataset = merge(Plan(**parameters), map(read, shards), read(limits))
    publish(snakemake, dataset, parameter_attributes(parameters), compressed=True)
