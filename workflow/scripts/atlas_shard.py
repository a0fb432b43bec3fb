"""One shard of the atlas, or the limits of all its families."""

from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.shards import limit_shard, shard
from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.pipeline.jobs import logged, publish

with logged(snakemake):
    parameters = snakemake.params.parameters
    name = snakemake.wildcards.shard
    plan = Plan(**parameters)
    if name == "limits":
        dataset = limit_shard(plan)
    else:
        number, _, _ = name.partition("-")
        dataset = shard(plan, int(number))
    publish(snakemake, dataset, parameter_attributes(parameters))
