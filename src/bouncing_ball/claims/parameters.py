"""The paper's parameters of each dataset; computed with others, a dataset decides no claim."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.datasets.netcdf import parameter_attributes

TOLERANCE = 0.01
"""The paper's limit for the error of the restitution model, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""ϖ above which the paper takes both models for equal."""
PERMANENT_CONTACT = 6.0
"""ϖ at which, by the paper, the thresholds of permanent contact differ by its limit."""


def _scan(low: float, high: float, samples: int) -> dict[str, Any]:
    return {"frequency_ratio": {"min": low, "max": high, "samples": samples}}


def _cases(*pairs: tuple[float, float]) -> list[dict[str, float]]:
    return [{"restitution": r, "amplitude": lam} for r, lam in pairs]


_SWEEP = _scan(1.0, 1000.0, 301)
_CASES = _cases((1.0, 0.8), (0.85, 1.0), (0.65, 1.0), (0.1, 2.6))
_TABLE = {"restitution": 0.85, "frequency_ratio": [1e4, 10.0, 2.0]}
_ORBIT = {"n": 1, "restitution": 0.65, "amplitude": 1.0}

# The paper's parameters, and the ranges that the conditions need as well.
PARAMETERS: dict[str, dict[str, Any]] = {
    "fig03": {"n": [1, 2, 3, 4, 5], "restitution": 0.85},
    "fig05": {"n": 1, "cases": _CASES, **_SWEEP},
    "fig06": {"n": 1, "cases": _cases((0.65, 0.7), (0.65, 1.0), (0.65, 1.2)), **_SWEEP},
    "fig08": {"n": 1, **_TABLE},
    "fig09": {"n": 2, **_TABLE},
    "fig10": {"n": 2, "restitution": 0.85, "amplitude": [1.1, 1.0, 0.6], **_SWEEP},
    "fig11": {"restitution": 0.65},
    "fig13": {**_ORBIT, **_SWEEP},
    "fig14": {**_ORBIT, **_SWEEP, "tolerance": TOLERANCE},
    "fig15": {"n": 2, "restitution": 0.65, "frequency_ratio": 10.0, "amplitude_max": 2.2},
    "fig16": {"restitution": 0.65, "tolerance": TOLERANCE, **_scan(0.5, 100.0, 401)},
    "table1": {"n": [1, 2, 3], **_TABLE},
    "thresholds": {**_ORBIT, "quantities": list(map(str, Quantity)), **_scan(1.0, 1e4, 101)},
    "ext_release": {"n": [1, 2, 3], "restitution": 0.85, **_scan(2.0, 1000.0, 61)},
    **{name: {} for name in ("formulas", "forensics", "witness", "ext_locking")},
}
"""The parameters of every dataset that decides claims; the release is always the displacement's."""


class NotAsked(Exception):
    """A dataset was computed with other parameters than the paper's."""


class PaperData(dict[str, xr.Dataset]):
    """Datasets by name, of which only those with the paper's parameters can be read.

    Reading another one raises :class:`NotAsked`. ``used`` names those that were read, in order.
    """

    def __init__(self, data: Mapping[str, xr.Dataset]) -> None:
        super().__init__(data)
        self.used: dict[str, None] = {}

    def __getitem__(self, name: str) -> xr.Dataset:
        data, release = super().__getitem__(name), {"release": "displacement"}
        given: dict[str, Any] = release | data.attrs
        for key, paper in (release | parameter_attributes(PARAMETERS[name])).items():
            # A list of one number is that number among the attributes.
            if not np.array_equal(np.ravel(given.get(key, "none")), np.ravel(paper)):
                raise NotAsked(
                    f"{name} was computed with {key} = {given.get(key)}; the claim requires {paper}"
                )
        self.used[name] = None
        return data
