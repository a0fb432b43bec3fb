"""Whether a dataset was computed with the paper's parameters; with others it decides no claim.

The parameters stand in ``config/config.yaml`` only, and a dataset carries those with which it was
computed. Whether they are the paper's is told by their digest. A test compares the digests below
with the configuration, and prints the new one when a parameter of the paper was read wrongly.
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

Data = Mapping[str, xr.Dataset]
"""Datasets by name."""

Digests = Mapping[str, tuple[str, ...]]
"""For each dataset the digest of its parameters, and the names of those that matter. Their values
are those of the same names in the configuration."""

PAPER: Digests = {
    "fig03": ("490a2404", "n", "restitution"),
    "fig05": ("edeaf406", "n", "cases", "frequency_ratio"),
    "fig06": ("12d97b1d", "n", "cases", "frequency_ratio"),
    "fig08": ("739bda6f", "n", "restitution", "frequency_ratio"),
    "fig09": ("482912af", "n", "restitution", "frequency_ratio"),
    "fig10": ("93b5b20c", "n", "restitution", "amplitude", "frequency_ratio"),
    "fig11": ("ec8ac312", "restitution"),
    "fig13": ("0886c529", "n", "restitution", "amplitude", "frequency_ratio"),
    "fig14": ("d5d8c016", "n", "restitution", "amplitude", "frequency_ratio", "tolerance"),
    "fig15": ("a308365c", "n", "restitution", "frequency_ratio", "amplitude_max"),
    "fig16": ("c4b1c6cd", "restitution", "tolerance", "frequency_ratio"),
    "table1": ("8f9d41fb", "n", "restitution", "frequency_ratio"),
    "thresholds": ("fba856d6", "n", "restitution", "amplitude", "quantities", "frequency_ratio"),
    "lowest_doubling": ("d0dc3420", "n", "restitution", "frequency_ratio"),
    "three_balls": ("c60ddcf3", "restitution", "amplitude"),
}
"""The paper's parameters, and the ranges that the conditions also need. Formulas, forensics and
witness are checks of ours, with any parameters."""


class NotAsked(Exception):
    """A dataset was computed with other parameters than the paper's."""


def of_dataset(attributes: Mapping[Any, Any], names: tuple[str, ...]) -> dict[str, list]:
    """The release and the named parameters among the attributes of a dataset, as lists.

    A nested parameter has its path as its name, such as ``frequency_ratio__min``. NetCDF keeps a
    list of one number as this number, so that every value is a list here.

    Examples
    --------
    >>> of_dataset({"title": "Figure", "n": np.int64(1), "span__min": 0.5}, ("n", "span"))
    {'release': ['displacement'], 'n': [1], 'span__min': [0.5]}
    """
    given = {"release": "displacement", **attributes}
    matter = ("release", *names)
    return {
        str(name): np.ravel(value).tolist()
        for name, value in given.items()
        if name in matter or str(name).partition("__")[0] in matter
    }


def digest(parameters: Mapping[str, list]) -> str:
    """Eight digits of the SHA-256 sum of parameters in any order; 1 is the same as 1.0.

    Examples
    --------
    >>> digest({"n": [1], "span__min": [0.5]}) == digest({"span__min": [0.5], "n": [1.0]})
    True
    """
    plain = {
        name: [x if isinstance(x, str) else float(x) for x in values]
        for name, values in parameters.items()
    }
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()[:8]


class PaperData(dict[str, xr.Dataset]):
    """Datasets by name, which raise :class:`NotAsked` when they are read unless their parameters
    are the required ones.

    ``used`` has the names of the datasets read, in order.
    """

    def __init__(self, data: Data, required: Digests) -> None:
        super().__init__(data)
        self.required = required
        self.used: dict[str, None] = {}

    def __getitem__(self, name: str) -> xr.Dataset:
        data = super().__getitem__(name)
        if name in self.required:
            expected, *names = self.required[name]
            found = of_dataset(data.attrs, tuple(names))
            if digest(found) != expected:
                given = (x if len(x) > 1 else x[0] for x in found.values())
                said = ", ".join(f"{key} = {x}" for key, x in zip(found, given, strict=True))
                raise NotAsked(f"{name} has other parameters than the claim requires: {said}")
        self.used[name] = None
        return data
