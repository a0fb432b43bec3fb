"""Whether the accepted samples in ``config`` are what the code of today computes.

A sample is a dataset that a run reads and does not make. It records the files that computed it with
digests of their code, without comments and docstrings (:func:`.sources.computation`): the modules
that its study imports, but for texts, names and pictures; for what physics engines gave, the files
that ran the engines. If one of these files computes something else today, the sample has to be made
again. A sample of a run also records a digest of its own content, because a number that was changed
afterwards need not be seen in any picture.
"""

import os
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path

import numpy as np
import xarray as xr

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.provenance import PREFIX, read_attributes
from bouncing_ball.pipeline.sources import changed_since, computation

COMPUTATION = f"{PREFIX}computation"
"""The attribute with the lines of :func:`.sources.computation`."""

CONTENT = f"{PREFIX}content"
"""The attribute with :func:`content_digest` of a sample, as it was when it was written."""

SECONDS = f"{PREFIX}seconds"
"""The attribute with the processor time that a sample took, or one of its shards."""

# More files than these are counted.
_NAMED = 4
# The attributes of a dataset and of its variables that belong to its content.
_WORDS = ("title", "references", "long_name", "units")


def computed_by(paths: Iterable[Path]) -> dict[str, str]:
    """The attribute of a sample that these files compute."""
    return {COMPUTATION: computation(paths)}


def content_digest(data: xr.Dataset) -> str:
    """A digest of the values, dimensions, names and units of a dataset, and of its title and its
    references; a dataset that was written and read has the same.

    Examples
    --------
    >>> one = xr.Dataset({"x": ("t", [1.0, 2.0])}, attrs={"title": "Figure 1"})
    >>> changed = one.assign(x=2 * one.x), one.assign_attrs(title="Figure 2"), one.rename(x="y")
    >>> [content_digest(each) == content_digest(one) for each in (one.copy(deep=True), *changed)]
    [True, False, False, False]
    """
    digest = sha256(repr([data.attrs.get(word) for word in _WORDS]).encode())
    for name in sorted(map(str, data.variables)):
        variable = data[name]
        words = [variable.attrs.get(word) for word in _WORDS]
        digest.update(repr((name, variable.dims, variable.shape, words)).encode())
        values = variable.values
        if values.dtype.kind in "OSUT":
            digest.update(repr([str(text) for text in values.ravel()]).encode())
            continue
        if values.dtype.kind == "f":
            # A file keeps that a number is missing, but not the bits of that.
            values = np.where(np.isnan(values), np.nan, values)
        digest.update(str(values.dtype).encode() + np.ascontiguousarray(values).tobytes())
    return digest.hexdigest()[:12]


def seconds_since(start: float = 0.0) -> dict[str, str]:
    """The attribute with the processor time of this process and of those that it has started and
    awaited, from a time of :func:`processor_time` on.
    """
    return {SECONDS: f"{processor_time() - start:.0f}"}


def processor_time() -> float:
    """The processor time of this process and of those that it has started and awaited, in s."""
    return sum(os.times()[:4])


def why_outdated(sample: Path) -> str:
    """What has changed since a sample was made, in one line; empty if nothing has.

    What physics engines gave does not record its content.

    Raises
    ------
    ModelError
        If the file cannot be read.
    """
    attributes = read_attributes(sample)
    recorded = str(attributes.get(COMPUTATION, ""))
    if not recorded:
        return "it does not record the code that computed it"
    changed = changed_since(recorded)
    if not changed:
        content = attributes.get(CONTENT)
        same = content is None or content == content_digest(read_dataset(sample))
        return "" if same else "its content was changed after it was computed"
    more = len(changed) - _NAMED
    rest = f" and {more} more" if more > 0 else ""
    return f"older than {', '.join(changed[:_NAMED])}{rest}"


def outdated(checkout: Path) -> dict[str, str]:
    """The samples of a checkout that are older than their code or were changed since, each with the
    reason.
    """
    found = {}
    for sample in sorted((checkout / "config").glob("*.nc")):
        try:
            why = why_outdated(sample)
        except ModelError as error:
            why = str(error)
        if why:
            found[sample.name] = why
    return found
