"""What the artifacts say of themselves: attributes of datasets, metadata of pictures."""

import io
import json
import warnings
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from bouncing_ball.record.provenance import Provenance, ProvenanceError
from bouncing_ball.record.reading import (
    MAX_PIXELS,
    UnreadableError,
    opened_dataset,
    printable,
    read_file,
)

_DESCRIPTION = "{http://purl.org/dc/elements/1.1/}description"


def _of_dataset(content: bytes) -> dict[str, Any]:
    with opened_dataset(content) as dataset:
        return {name: dataset.getncattr(name) for name in dataset.ncattrs()}


def _of_png(content: bytes) -> dict[str, Any]:
    from PIL import Image

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Reads up to where the pixels begin.
        with Image.open(io.BytesIO(content), formats=["PNG"]) as picture:
            if picture.width * picture.height > MAX_PIXELS:
                raise UnreadableError(f"more than {MAX_PIXELS} pixels")
            return {str(key): value for key, value in picture.info.items()}


def _of_svg(content: bytes) -> dict[str, Any]:
    if b"<!ENTITY" in content:
        raise UnreadableError("defines entities")
    for _, element in ElementTree.iterparse(io.BytesIO(content)):
        if element.tag == _DESCRIPTION:
            attributes = json.loads(element.text or "")
            if not isinstance(attributes, dict):
                raise ValueError("not a mapping")
            return attributes
    return {}


_READERS = {".nc": _of_dataset, ".png": _of_png, ".svg": _of_svg}

CARRIERS = tuple(_READERS)
"""Suffixes of the files that carry their provenance; texts and tables do not."""


def read_attributes(path: Path) -> dict[str, Any]:
    """Attributes of a dataset, metadata of a picture.

    The file may be anybody's: see :mod:`bouncing_ball.record.reading`.

    Raises
    ------
    ProvenanceError
        If the file is of another kind, cannot be read, or is damaged.
    """
    shown = printable(path)
    reader = _READERS.get(path.suffix)
    if reader is None:
        raise ProvenanceError(f"{shown} is not one of {', '.join(CARRIERS)}")
    try:
        return reader(read_file(path.parent, path.name))
    except UnreadableError as error:
        raise ProvenanceError(f"{shown} cannot be read: {error}") from None
    # The libraries raise errors of many types on a damaged file.
    except Exception:
        raise ProvenanceError(f"{shown} cannot be read: damaged, or not ours") from None


def read_provenance(path: Path) -> Provenance:
    """The provenance that an artifact carries.

    Raises
    ------
    ProvenanceError
        If there is none.
    """
    attributes = read_attributes(path)
    try:
        return Provenance.of(attributes)
    except ProvenanceError as error:
        raise ProvenanceError(f"{printable(path)} carries no provenance: {error}") from None
