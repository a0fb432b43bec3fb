"""How fast the errors of both models fall along the frequency ratio."""

from bouncing_ball_beyond.exhibits.corrected_model import orders
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, orders)
