"""The paper's parameters of each dataset; with other parameters a dataset decides no claim."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.datasets.netcdf import parameter_attributes

PARAMETERS: dict[str, dict[str, Any]] = read_yaml(Path(__file__).with_suffix(".yaml"))
"""The paper's parameters of every dataset that decides claims, and the ranges that the conditions
also need. The release is always the displacement release."""
TOLERANCE: float = PARAMETERS["fig14"]["tolerance"]
"""The paper's limit for the error of the restitution model, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""ϖ above which the paper treats both models as equal."""
PERMANENT_CONTACT = 6.0
"""ϖ at which, according to the paper, the thresholds of permanent contact differ by its limit."""


class NotAsked(Exception):
    """A dataset was computed with other parameters than the paper's."""


class PaperData(dict[str, xr.Dataset]):
    """Datasets by name; only a dataset with the paper's parameters can be read.

    Reading any other dataset raises :class:`NotAsked`. ``used`` has the names of the datasets read,
    in order.
    """

    def __init__(self, data: Mapping[str, xr.Dataset]) -> None:
        super().__init__(data)
        self.used: dict[str, None] = {}

    def __getitem__(self, name: str) -> xr.Dataset:
        data, release = super().__getitem__(name), {"release": "displacement"}
        given: dict[str, Any] = release | data.attrs
        for key, paper in (release | parameter_attributes(PARAMETERS[name])).items():
            # netCDF stores an attribute that is a list of one number as this number.
            if not np.array_equal(np.ravel(given.get(key, "none")), np.ravel(paper)):
                raise NotAsked(
                    f"{name} was computed with {key} = {given.get(key)}; the claim requires {paper}"
                )
        self.used[name] = None
        return data
