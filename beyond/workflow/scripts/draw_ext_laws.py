"""The figure ext_laws."""

from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw
from bouncing_ball_beyond.exhibits.contact_laws_figures import contact_laws

with logged(snakemake):
    draw(snakemake, contact_laws)
