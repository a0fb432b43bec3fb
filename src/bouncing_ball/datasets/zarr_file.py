"""A dataset as chunked Zarr in one file, for publication.

A zip archive and not a folder: the chunks, hundreds of them, would be as many small files, which a
parallel file system dislikes; one file has one checksum, and is written whole or not at
all. Unpacked it is the folder, for a server of objects. Format 2 of Zarr, whose
texts and truth values every reader knows.
"""

import zipfile
from collections.abc import Collection
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.datasets.atomic import replacing
from bouncing_ball.datasets.netcdf import DatasetError

_LEVEL = 5
# An archive says when its files were written; this is the first time that it can.
_TIME = (1980, 1, 1, 0, 0, 0)


def write_zarr(dataset: xr.Dataset, path: str | Path, apart: Collection[str]) -> None:
    """Write a dataset as zipped Zarr, the same bytes every time.

    Parameters
    ----------
    dataset : Dataset
    path : path
    apart : collection of str
        Dimensions along which each index has chunks of its own; the others are whole.

    Raises
    ------
    DatasetError
        If zarr is not installed.
    """
    try:
        from numcodecs import Zstd
        from zarr.storage import MemoryStore
    except ImportError:
        needed = "pip install 'bouncing-ball[zarr]'"
        raise DatasetError(f"Zarr needs the extra zarr: {needed}") from None
    encoding: dict[str, dict[str, Any]] = {
        str(name): {
            "chunks": tuple(1 if d in apart else size for d, size in values.sizes.items()),
            "compressors": [Zstd(level=_LEVEL)],
        }
        for name, values in dataset.data_vars.items()
        if values.ndim
    }
    held: dict[str, Any] = {}
    # What the netCDF file was packed with is of no account here.
    dataset.drop_encoding().to_zarr(
        MemoryStore(held), zarr_format=2, consolidated=True, encoding=encoding
    )
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name in sorted(held):
            archive.writestr(zipfile.ZipInfo(name, _TIME), held[name].to_bytes())
