"""Orbits of the restitution model."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies import restitution_families as restitution_orbits

study = {
    "fig02": restitution_orbits.restitution_history,
    "fig03": restitution_orbits.restitution_orbits,
}[snakemake.wildcards.figure]
make_dataset(snakemake, study)
