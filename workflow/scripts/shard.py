"""What is found at the places of one shard of a study."""

import xarray as xr

from bouncing_ball.configuration.study import load, typed
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.datasets.pieces import Followed, only
from bouncing_ball.pipeline.job import logged, publish

with logged(snakemake):
    job, number = snakemake.params, snakemake.wildcards.shard.split("-of-")
    try:
        typed(load(job.study))(**job.arguments, follow=only(*map(int, number)))
    except Followed as found:
        (arrays,) = found.args
        # Each with dimensions of its own.
        part = {x: ([f"{x}_{k}" for k in range(y.ndim)], y) for x, y in arrays.items()}
        publish(snakemake, xr.Dataset(part), parameter_attributes(job.arguments))
