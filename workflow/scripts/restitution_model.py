"""The restitution model: one orbit over time, and all orbits in closed form."""

from bouncing_ball.paper.exhibits.restitution_model import restitution_history, restitution_orbits
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig02=restitution_history, fig03=restitution_orbits)
