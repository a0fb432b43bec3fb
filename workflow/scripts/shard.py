"""The arrays of the places of one shard of a study."""

import xarray as xr

from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.datasets.shards import part_of
from bouncing_ball.pipeline.configuration import load, typed
from bouncing_ball.pipeline.jobs import logged, publish

with logged(snakemake):
    job, part = snakemake.params, part_of(snakemake.wildcards.shard)
    arrays = typed(load(job.places))(**job.arguments, part=part)
    # Each array has dimensions of its own.
    data = {x: ([f"{x}_{k}" for k in range(y.ndim)], y) for x, y in arrays.items()}
    publish(snakemake, xr.Dataset(data), parameter_attributes(job.arguments))
