"""The atlas as chunked Zarr."""

from bouncing_ball.datasets.zarr_file import write_zarr
from bouncing_ball.pipeline.atlas import log_of
from bouncing_ball.pipeline.job import logged, read_input

# What a map shows is one chunk: a rule, a family and a quantity over all tiles.
APART = ("release", "n", "quantity", "limit_quantity")

with logged(snakemake):
    (path,) = snakemake.input.parts
    write_zarr(read_input(path, log_of(path)), snakemake.output.data, APART)
