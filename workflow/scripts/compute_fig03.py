"""All orbits of the restitution model, in closed form."""

from bouncing_ball.paper.exhibits.restitution_model import restitution_orbits
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, restitution_orbits)
