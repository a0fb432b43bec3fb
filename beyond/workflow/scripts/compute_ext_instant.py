"""Flights before and after a contact, which meet at the centroid of its force."""

from bouncing_ball_beyond.exhibits.corrected_model import meeting_flights
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, meeting_flights)
