"""Figure 4."""

from bouncing_ball.paper.exhibits.schematics_figures import spring_damper_model
from bouncing_ball.pipeline.figures_and_tables import draw
from bouncing_ball.pipeline.job import logged

with logged(snakemake):
    draw(snakemake, spring_damper_model)
