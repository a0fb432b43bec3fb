"""One shard of the atlas, or its answers about the limits of the families."""

from pathlib import Path

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.shards import limit_shard, shard
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.job import logged, publish
from bouncing_ball.pipeline.progress import Progress

with logged(snakemake) as lines:
    plan, name = Plan(snakemake.params.parameters), snakemake.wildcards.shard
    if name == "limits":
        dataset = limit_shard(plan)
    else:
        index = int(name.partition("-")[0])
        own = len(plan.shard(index)) * plan.orbits_per_row
        folder = Path(snakemake.output.data).parents[1] / "progress"
        dataset = shard(plan, index, Progress(folder, name, own, plan.orbits))
        lines.append(f"{own} orbits")
    publish(snakemake, dataset, parameter_attributes(plan.parameters), compressed=True)
