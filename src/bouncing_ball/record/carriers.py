"""What the artifacts say of themselves: attributes of datasets, metadata of pictures."""

import json
import warnings
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from bouncing_ball.record.provenance import Provenance, ProvenanceError

_DESCRIPTION = "{http://purl.org/dc/elements/1.1/}description"


def _of_dataset(path: Path) -> dict[str, Any]:
    from netCDF4 import Dataset

    with Dataset(path) as dataset:
        return {name: dataset.getncattr(name) for name in dataset.ncattrs()}


def _of_png(path: Path) -> dict[str, Any]:
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(path, formats=["PNG"]) as picture:
                return {str(key): value for key, value in picture.info.items()}
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise ProvenanceError(f"{path} cannot be read: too large a picture") from None


def _of_svg(path: Path) -> dict[str, Any]:
    for _, element in ElementTree.iterparse(path):
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

    Raises
    ------
    ProvenanceError
        If the file is none of these, or is damaged.
    """
    reader = _READERS.get(path.suffix)
    if reader is None:
        raise ProvenanceError(f"{path} is not one of {', '.join(CARRIERS)}")
    try:
        return reader(path)
    except ProvenanceError:
        raise
    # A damaged SVG is a SyntaxError, one with another description a ValueError.
    except (OSError, SyntaxError, ValueError) as error:
        why = "no such file" if isinstance(error, FileNotFoundError) else "damaged, or not ours"
        raise ProvenanceError(f"{path} cannot be read: {why}") from None


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
        raise ProvenanceError(f"{path} carries no provenance: {error}") from None
