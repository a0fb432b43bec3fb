"""The paper's parameters by dataset: computed with others, a dataset decides no claim."""

import json
import operator
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.datasets.netcdf import attribute_name
from bouncing_ball.errors import ModelError

TOLERANCE = 0.01
"""The paper's limit for the error of the restitution model, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""ϖ from which on the paper takes both models for the same."""
PERMANENT_CONTACT = 6.0
"""ϖ at which, by the paper, the thresholds of permanent contact differ by its limit."""


# What a parameter must be where more than one value will do.
_HOLDS: dict[str, Callable[[Any, Any], bool]] = {
    "at least": operator.ge,
    "at most": operator.le,
    "all of": lambda given, values: set(values) <= set(_listed(given)),
}


def _listed(value: Any) -> list:
    return value if isinstance(value, list) else [value]


def _cases(*pairs: tuple[float, float]) -> list[dict[str, float]]:
    return [{"restitution": r, "amplitude": lam} for r, lam in pairs]


_FAR = {"frequency_ratio.max": ("at least", 1000.0)}
_SCAN = {**_FAR, "frequency_ratio.min": 1.0, "frequency_ratio.samples": ("at least", 101)}

# Required of every dataset that has the parameter.
COMMON: dict[str, Any] = {"release": "displacement"}
# As the attributes hold them: the paper's, and the ranges that the conditions need besides.
PARAMETERS: dict[str, dict[str, Any]] = {
    "fig03": {"n": [1, 2, 3, 4, 5], "restitution": 0.85},
    "fig05": {"n": 1, "cases": _cases((1.0, 0.8), (0.85, 1.0), (0.65, 1.0), (0.1, 2.6)), **_SCAN},
    "fig06": {"n": 1, "cases": _cases((0.65, 0.7), (0.65, 1.0), (0.65, 1.2)), **_SCAN},
    "fig08": {"n": 1, "restitution": 0.85, "frequency_ratio": [1e4, 10.0, 2.0]},
    "fig09": {"n": 2, "restitution": 0.85, "frequency_ratio": [1e4, 10.0, 2.0]},
    "fig10": {"n": 2, "restitution": 0.85, "amplitude": [1.1, 1.0, 0.6], **_SCAN},
    "fig11": {"restitution": 0.65},
    "fig13": {"n": 1, "restitution": 0.65, "amplitude": [1.0], **_FAR},
    "fig14": {"n": 1, "restitution": 0.65, "amplitude": 1.0, "tolerance": TOLERANCE, **_FAR},
    # Beyond both period doublings.
    "fig15": {
        "n": 2,
        "restitution": 0.65,
        "frequency_ratio": 10.0,
        "amplitude_max": ("at least", 2),
    },
    "fig16": {
        "restitution": 0.65,
        "tolerance": TOLERANCE,
        "frequency_ratio.min": ("at most", PERMANENT_CONTACT),
        "frequency_ratio.max": ("at least", 100.0),
        "frequency_ratio.samples": ("at least", 101),
    },
    "table1": {"n": [1, 2, 3], "restitution": 0.85, "frequency_ratio": [1e4, 10.0, 2.0]},
    "thresholds": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "quantities": ("all of", list(map(str, Quantity))),
        "tolerances": ("all of", [TOLERANCE, 0.005, 0.002]),
        **_SCAN,
        "frequency_ratio.max": ("at least", 1e4),
    },
    "ext_release": {
        "n": [1, 2, 3],
        "restitution": 0.85,
        "frequency_ratio.min": 2.0,
        "frequency_ratio.samples": ("at least", 61),
        **_FAR,
    },
    "motions": {"n": 1, "restitution": 0.85, "amplitude": ("all of", [1.0, 1.1, 2.0])},
    "formulas": {},
    "forensics": {},
    "witness": {},
}


class NotAsked(Exception):
    """A dataset was computed with other parameters than the paper's."""


def _plain(value: Any) -> Any:
    """An attribute as numbers, texts and lists: arrays and JSON undone."""
    if isinstance(value, str) and value[:1] in ("[", "{"):
        # Nested parameters are JSON among a dataset's attributes.
        with suppress(ValueError):
            return json.loads(value)
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _agrees(given: Any, paper: Any) -> bool:
    if isinstance(paper, tuple):
        words, limit = paper
        # A text where a number is needed is not the paper's.
        with suppress(TypeError):
            return _HOLDS[words](given, limit)
        return False
    # A list of one number is that number among the attributes.
    return _listed(given) == _listed(paper)


class PaperData(dict[str, xr.Dataset]):
    """Datasets by name, as far as they have the paper's parameters.

    Taking one that has others raises :class:`NotAsked`; one without a required
    parameter, or none, raises :class:`~bouncing_ball.errors.ModelError`. ``used`` names
    those taken, in their order.
    """

    def __init__(self, data: Mapping[str, xr.Dataset]) -> None:
        super().__init__(data)
        self.used: dict[str, None] = {}

    def __getitem__(self, name: str) -> xr.Dataset:
        if name not in PARAMETERS or name not in self:
            raise ModelError(f"no dataset {name}")
        data = super().__getitem__(name)
        for key, paper in {**COMMON, **PARAMETERS[name]}.items():
            words = " ".join(map(str, paper)) if isinstance(paper, tuple) else paper
            given = _plain(data.attrs.get(attribute_name(key)))
            if given is None and key not in COMMON:
                raise ModelError(f"dataset {name} has no parameter {key}, required: {words}")
            if given is not None and not _agrees(given, paper):
                raise NotAsked(
                    f"{name} was computed with {key} = {given}; the claim requires {words}"
                )
        self.used[name] = None
        return data
