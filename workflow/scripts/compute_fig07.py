"""One cycle of the spring-damper model."""

from bouncing_ball.paper.exhibits.time_histories import contact_history
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, contact_history)
