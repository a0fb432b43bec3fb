"""The atlas from its shards."""

from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.shards import merge
from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.pipeline.jobs import logged, publish, read_input

with logged(snakemake):
    parameters = snakemake.params.parameters
    *shards, limits = snakemake.input.parts
    dataset = merge(Plan(**parameters), map(read_input, shards), read_input(limits))
    publish(snakemake, dataset, parameter_attributes(parameters))
