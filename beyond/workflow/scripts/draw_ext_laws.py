"""The figure ext_laws."""

from bouncing_ball_beyond.exhibits.contact_laws_figures import contact_laws
from bouncing_ball_beyond.inherited.pipeline.job import logged
from bouncing_ball_beyond.inherited.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, contact_laws)
