"""The summary of the atlas."""

from bouncing_ball.atlas.plan import Plan
from bouncing_ball.atlas.summary import summary
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.job import logged, publish, read_input

with logged(snakemake):
    plan = Plan(snakemake.params.parameters)
    asked = plan.parameters["summary"]
    (path,) = snakemake.input.parts
    atlas = read_input(path)
    dataset = summary(plan, atlas, asked["tolerance"], asked["rule_of_thumb"])
    publish(snakemake, dataset, parameter_attributes(plan.parameters), compressed=True)
