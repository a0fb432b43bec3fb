"""The figure ext_impact."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.release_rules_figures import free_impacts

with job.logged(snakemake):
    draw(snakemake, free_impacts)
