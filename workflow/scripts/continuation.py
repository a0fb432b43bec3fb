"""n-T orbits by continuation."""

from functools import partial

from bouncing_ball.pipeline.job import make_dataset
from bouncing_ball.studies import orbit_branches as continuation

study = {
    "fig08": continuation.orbit_branches,
    "fig09": continuation.orbit_branches,
    "fig15": continuation.both_domains,
    "table1": partial(continuation.stability_ranges, printed=snakemake.params.printed),
}[snakemake.wildcards.figure]
make_dataset(snakemake, study, snakemake.params.release, snakemake.params.continuation)
