"""The summary of the atlas."""

from bouncing_ball.atlas.plan import AtlasParameters
from bouncing_ball.atlas.summary import summary
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.job import logged, publish, read_input

with logged(snakemake):
    parameters = snakemake.params.parameters
    (path,) = snakemake.input.parts
    dataset = summary(AtlasParameters(**parameters), read_input(path))
    publish(snakemake, dataset, parameter_attributes(parameters), compressed=True)
