"""Files that are written completely or not at all, and datasets as netCDF files.

The same dataset has the same bytes every time.
"""

import errno
import json
import math
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball_beyond.inherited.errors import ModelError, extra, printable

PICTURES = (".pdf", ".png", ".svg")
"""Suffixes of the figures that users request."""

CONVENTIONS = "CF-1.11"
"""The netCDF conventions that the files follow."""


# A netCDF file is larger than its arrays by its header and by blocks that are not filled; in bytes.
_OVERHEAD = 1 << 18
# Numbers in the largest dataset that is read: a gigabyte. A file of some kilobytes may declare any.
_LARGEST = 1 << 27


def require_writable(path: Path | None, suffixes: Sequence[str] = ()) -> None:
    """Refuse a file that cannot be written, before its contents are computed; None is no file.

    Raises
    ------
    ModelError
        If the path has none of the suffixes, if its folder does not exist or is not writable, or if
        there is something else than a file, such as a device or a link, which a file would replace.

    Examples
    --------
    >>> require_writable(Path("page.jpg"), PICTURES)
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: 'page.jpg' does not end in .pdf or .png or \
.svg
    """
    if path is None:
        return
    if suffixes and path.suffix not in suffixes:
        raise ModelError(f"'{path}' does not end in {' or '.join(suffixes)}")
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise ModelError(f"{path} cannot be written: it is no regular file")
    folder = path.absolute().parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise ModelError(f"{path} cannot be written: {folder} is no folder that can be written to")


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """A temporary path in the same folder, whose file replaces ``path`` if no error occurs.

    On an error the temporary file is removed. Its suffix is that of ``path``, because writers take
    the format from the suffix.

    Raises
    ------
    OSError
        If the file cannot be replaced.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write UTF-8 text, with the same line endings on every system.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def parameter_attributes(parameters: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested parameters as flat netCDF attributes, with CF names, which contain no points.

    Lists of numbers remain lists; lists of anything else become JSON.

    Examples
    --------
    >>> parameter_attributes({"n": 1, "range": {"min": 0.5}, "cases": [{"r": 1}]})
    {'n': 1, 'range__min': 0.5, 'cases': '[{"r": 1}]'}
    """
    flat: dict[str, Any] = {}
    for key, value in parameters.items():
        name = (prefix + key).replace(".", "__")
        if isinstance(value, Mapping):
            flat |= parameter_attributes(value, f"{name}.")
        elif isinstance(value, list) and not all(type(x) in (int, float) for x in value):
            flat[name] = json.dumps(value, ensure_ascii=False)
        else:
            flat[name] = int(value) if isinstance(value, bool) else value
    return flat


def write_dataset(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a dataset under the CF conventions, completely or not at all.

    Coordinates have no fill value, because all their values exist.

    Raises
    ------
    OSError
        If the file cannot be written; if the disk is full, the error says so.
    """
    encoding: dict[str, dict[str, Any]] = {str(x): {"_FillValue": None} for x in dataset.coords}
    with replacing(path) as temporary:
        try:
            dataset.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=encoding)
        except (OSError, RuntimeError) as error:
            # To the libraries this is an error of HDF, or of permissions.
            if shutil.disk_usage(temporary.parent).free < dataset.nbytes + _OVERHEAD:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path)) from error
            raise


def require_readable(path: str | Path) -> None:
    """Refuse a pipe or a device, which would be read for ever, and a folder.

    Raises
    ------
    ModelError
        If there is something else than a file, or nothing.
    """
    if not os.path.isfile(path):
        what = "it is no regular file" if os.path.lexists(path) else "no such file"
        raise ModelError(f"{printable(path, None)} cannot be read: {what}")


def _require_small(path: str | Path) -> None:
    """Refuse a dataset whose arrays would not fit into memory, before one of them is read."""
    # Imported here, because the library itself needs no netCDF.
    with extra("pipeline"):
        from netCDF4 import Dataset

    with Dataset(path) as header:
        sizes = [math.prod(each.shape) for each in header.variables.values()]
    if sum(sizes) > _LARGEST:
        raise ModelError(
            f"{printable(path, None)} is damaged: its arrays have {sum(sizes):.1e} numbers"
        )


def read_dataset(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory and close its file.

    Raises
    ------
    ModelError
        If the file does not exist, is no file, is damaged, or holds more than memory does.
    """
    if not os.path.lexists(path):
        raise ModelError(f"no dataset {printable(path, None)}")
    require_readable(path)
    try:
        _require_small(path)
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            return dataset.load()
    except ModelError:
        raise
    # The type of the error that the libraries raise depends on the place of the damage.
    except (OSError, ValueError, RuntimeError, AttributeError) as error:
        raise ModelError(f"{printable(path, None)} is damaged") from error
