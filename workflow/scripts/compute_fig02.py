"""One orbit of the restitution model over time."""

from bouncing_ball.paper.exhibits.restitution_model import restitution_history
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, restitution_history)
