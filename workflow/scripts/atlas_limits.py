"""The answers of the atlas about the limits of the families."""

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.shards import limit_shard
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.job import logged, publish

with logged(snakemake):
    plan = Plan(snakemake.params.parameters)
    publish(snakemake, limit_shard(plan), parameter_attributes(plan.parameters), compressed=True)
