"""The atlas from its shards."""

from bouncing_ball.atlas.merge import merge
from bouncing_ball.atlas.plan import Plan
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.atlas import read_part, read_shards
from bouncing_ball.pipeline.job import logged, publish

with logged(snakemake):
    plan = Plan(snakemake.params.parameters)
    *shards, limits = snakemake.input.parts
    dataset = merge(plan, read_shards(shards), read_part(limits))
    publish(snakemake, dataset, parameter_attributes(plan.parameters), compressed=True)
