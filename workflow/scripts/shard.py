"""The arrays of the places of one shard of a study."""

from time import process_time

import xarray as xr
from adapter import function

from bouncing_ball.datasets.shards import part_of
from bouncing_ball.pipeline.configuration import typed
from bouncing_ball.pipeline.jobs import logged, publish, recorded

with logged(snakemake):
    job = snakemake.params
    places = typed(function(job.module, job.places))
    arrays = places(**job.arguments, part=part_of(snakemake.wildcards.shard))
    data = {}
    for name, values in arrays.items():
        # Each array has dimensions of its own.
        dimensions = [f"{name}_{k}" for k in range(values.ndim)]
        data[name] = (dimensions, values)
    publish(snakemake, xr.Dataset(data), recorded(job.arguments), seconds=process_time())
