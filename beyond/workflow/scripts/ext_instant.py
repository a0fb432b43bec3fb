"""Flights before and after a contact, which meet at the centroid of its force."""

import bouncing_ball.pipeline.job as job
from bouncing_ball.pipeline.datasets import make_datasets
from bouncing_ball_beyond.exhibits.corrected_model import meeting_flights

with job.logged(snakemake):
    make_datasets(snakemake, ext_instant=meeting_flights)
