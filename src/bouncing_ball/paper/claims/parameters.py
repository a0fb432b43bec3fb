"""The paper's parameters of each dataset; with other parameters a dataset decides no claim."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets.files import parameter_attributes

PARAMETERS: dict[str, dict[str, Any]] = {
    "fig03": {"n": [1, 2, 3, 4, 5], "restitution": 0.85},
    "fig05": {
        "n": 1,
        "cases": [
            {"restitution": 1.0, "amplitude": 0.8},
            {"restitution": 0.85, "amplitude": 1.0},
            {"restitution": 0.65, "amplitude": 1.0},
            {"restitution": 0.1, "amplitude": 2.6},
        ],
        "frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 301},
    },
    "fig06": {
        "n": 1,
        "cases": [
            {"restitution": 0.65, "amplitude": 0.7},
            {"restitution": 0.65, "amplitude": 1.0},
            {"restitution": 0.65, "amplitude": 1.2},
        ],
        "frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 301},
    },
    "fig08": {"n": 1, "restitution": 0.85, "frequency_ratio": [10000.0, 10.0, 2.0]},
    "fig09": {"n": 2, "restitution": 0.85, "frequency_ratio": [10000.0, 10.0, 2.0]},
    "fig10": {
        "n": 2,
        "restitution": 0.85,
        "amplitude": [1.1, 1.0, 0.6],
        "frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 301},
    },
    "fig11": {"restitution": 0.65},
    "fig13": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 301},
    },
    "fig14": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "frequency_ratio": {"min": 1.0, "max": 1000.0, "samples": 301},
        "tolerance": 0.01,
    },
    "fig15": {"n": 2, "restitution": 0.65, "frequency_ratio": 10.0, "amplitude_max": 2.2},
    "fig16": {
        "restitution": 0.65,
        "tolerance": 0.01,
        "frequency_ratio": {"min": 0.5, "max": 100.0, "samples": 401},
    },
    "table1": {"n": [1, 2, 3], "restitution": 0.85, "frequency_ratio": [10000.0, 10.0, 2.0]},
    "thresholds": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "quantities": [
            "max_height",
            "bounce_velocity",
            "phase",
            "apparent_restitution",
            "saddle_node",
            "period_doubling",
            "permanent_contact",
        ],
        "frequency_ratio": {"min": 1.0, "max": 10000.0, "samples": 101},
    },
    "lowest_doubling": {
        "n": [1, 2, 3],
        "restitution": 0.85,
        "frequency_ratio": {"min": 2.0, "max": 1000.0, "samples": 61},
    },
    "formulas": {},
    "forensics": {},
    "witness": {},
    "three_balls": {"restitution": 0.5, "amplitude": [1.2, 1.6, 1.75]},
}
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
    """Datasets by name; only a dataset with these parameters, by default the paper's, can be read.

    Reading any other dataset raises :class:`NotAsked`. ``used`` has the names of the datasets read,
    in order.
    """

    def __init__(
        self,
        data: Mapping[str, xr.Dataset],
        parameters: Mapping[str, Mapping[str, Any]] | None = None,
    ) -> None:
        super().__init__(data)
        self.parameters = PARAMETERS if parameters is None else parameters
        self.used: dict[str, None] = {}

    def __getitem__(self, name: str) -> xr.Dataset:
        data = super().__getitem__(name)
        release = {"release": "displacement"}
        given: dict[str, Any] = release | data.attrs
        for key, paper in (release | parameter_attributes(self.parameters[name])).items():
            # netCDF stores an attribute that is a list of one number as this number.
            if not np.array_equal(np.ravel(given.get(key, "none")), np.ravel(paper)):
                raise NotAsked(
                    f"{name} was computed with {key} = {given.get(key)}; the claim requires {paper}"
                )
        self.used[name] = None
        return data
