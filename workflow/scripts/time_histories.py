"""Time histories of the spring-damper model."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies import time_histories

study = {
    "fig07": time_histories.contact_history,
    "fig12": time_histories.both_histories,
}[snakemake.wildcards.figure]
make_dataset(snakemake, study, snakemake.params.release)
