"""Time histories of orbits of the spring-damper model."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.paper.exhibits.time_histories import both_histories, contact_history
from bouncing_ball.pipeline.datasets import make_datasets

with job.logged(snakemake):
    make_datasets(snakemake, fig07=contact_history, fig12=both_histories)
