"""Figure 11."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.permanent_contact_figures import permanent_contact
from bouncing_ball.pipeline.pictures import draw

with job.logged(snakemake):
    draw(snakemake, permanent_contact)
