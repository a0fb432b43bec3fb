"""The figure ext_impact."""

from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.release_rules_figures import free_impacts

with logged(snakemake):
    draw(snakemake, free_impacts)
