"""Figure 4."""

from bouncing_ball.paper.exhibits.schematics_figures import spring_damper_model
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, spring_damper_model)
