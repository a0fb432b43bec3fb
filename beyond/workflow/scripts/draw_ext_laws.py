"""The figure ext_laws."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.contact_laws_figures import contact_laws

with job.logged(snakemake):
    draw(snakemake, contact_laws)
