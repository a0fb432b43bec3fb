"""The summary of the atlas."""

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.summary import summary
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.atlas import read_part
from bouncing_ball.pipeline.job import logged, publish

with logged(snakemake):
    plan = Plan(snakemake.params.parameters)
    asked = plan.parameters["summary"]
    atlas = read_part(snakemake.input.parts[0])
    dataset = summary(plan, atlas, asked["tolerance"], asked["rule_of_thumb"])
    publish(snakemake, dataset, parameter_attributes(plan.parameters), compressed=True)
