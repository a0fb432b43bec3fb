"""One shard of the atlas, or the limits of all its families."""

from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.shards import limit_shard, shard
from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.pipeline.jobs import logged, publish

with logged(snakemake):
    parameters, name = snakemake.params.parameters, snakemake.wildcards.shard
    plan = Plan(**parameters)
    dataset = limit_shard(plan) if name == "limits" else shard(plan, int(name.partition("-")[0]))
    publish(snakemake, dataset, parameter_attributes(parameters), compressed=True)
