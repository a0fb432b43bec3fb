"""The restitution model: one orbit over time, and all orbits in closed form."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.restitution_model import restitution_history, restitution_orbits
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig02=restitution_history, fig03=restitution_orbits)
