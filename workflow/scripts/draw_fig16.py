"""Figure 16."""

from bouncing_ball.paper.exhibits.permanent_contact_figures import permanent_contact_error
from bouncing_ball.pipeline.job import logged
from bouncing_ball.pipeline.pictures import draw

with logged(snakemake):
    draw(snakemake, permanent_contact_error)
