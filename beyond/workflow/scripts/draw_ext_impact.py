"""The figure ext_impact."""

from bouncing_ball_beyond.exhibits.release_rules_figures import free_impacts
from bouncing_ball_beyond.inherited.pipeline.job import logged
from bouncing_ball_beyond.inherited.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, free_impacts)
