"""Relative errors and their thresholds."""

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies import error_thresholds

study = {
    "fig14": error_thresholds.height_error,
    "fig16": error_thresholds.permanent_contact_error,
    "thresholds": error_thresholds.error_thresholds,
}[snakemake.wildcards.figure]
make_dataset(snakemake, study, snakemake.params.release)
