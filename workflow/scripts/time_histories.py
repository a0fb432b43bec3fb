"""Time histories of orbits of the spring-damper model."""

from bouncing_ball.paper.exhibits.time_histories import both_histories, contact_history
from bouncing_ball.pipeline.job import logged, make_datasets

with logged(snakemake):
    make_datasets(snakemake, fig07=contact_history, fig12=both_histories)
