"""The paper's parameters by dataset: computed with others, a dataset decides no claim."""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets.netcdf import attribute_name
from bouncing_ball.errors import ModelError

TOLERANCE = 0.01
"""The paper's limit for the error of the restitution model, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""ϖ from which on the paper takes both models for the same."""
PERMANENT_CONTACT = 6.0
"""ϖ at which, by the paper, the thresholds of permanent contact differ by its limit."""


@dataclass(frozen=True)
class _Needed:
    """What a parameter must be, where more than one value will do."""

    words: str
    holds: Callable[[Any], bool]

    def __str__(self) -> str:
        return self.words


def _at_least(limit: float) -> _Needed:
    return _Needed(f"at least {limit}", lambda given: given >= limit)


def _at_most(limit: float) -> _Needed:
    return _Needed(f"at most {limit}", lambda given: given <= limit)


def _all_of(*values: Any) -> _Needed:
    return _Needed(f"all of {list(values)}", lambda given: set(values) <= set(_listed(given)))


def _listed(value: Any) -> list:
    return value if isinstance(value, list) else [value]


def _cases(*pairs: tuple[float, float]) -> list[dict[str, float]]:
    return [{"restitution": r, "amplitude": lam} for r, lam in pairs]


_FAR = {"frequency_ratio.max": _at_least(1000.0)}
_SCAN = {**_FAR, "frequency_ratio.min": 1.0, "frequency_ratio.samples": _at_least(101)}
_QUANTITIES = ("max_height", "bounce_velocity", "phase", "apparent_restitution")
_QUANTITIES += ("saddle_node", "period_doubling", "permanent_contact")

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
    "fig15": {"n": 2, "restitution": 0.65, "frequency_ratio": 10.0, "amplitude_max": _at_least(2)},
    "fig16": {
        "restitution": 0.65,
        "tolerance": TOLERANCE,
        "frequency_ratio.min": _at_most(PERMANENT_CONTACT),
        "frequency_ratio.max": _at_least(100.0),
        "frequency_ratio.samples": _at_least(101),
    },
    "table1": {"n": [1, 2, 3], "restitution": 0.85, "frequency_ratio": [1e4, 10.0, 2.0]},
    "thresholds": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "quantities": _all_of(*_QUANTITIES),
        "tolerances": _all_of(TOLERANCE, 0.005, 0.002),
        **_SCAN,
        "frequency_ratio.max": _at_least(1e4),
    },
    "ext_release": {
        "n": [1, 2, 3],
        "restitution": 0.85,
        "frequency_ratio.min": 2.0,
        "frequency_ratio.samples": _at_least(61),
        **_FAR,
    },
    "motions": {"n": 1, "restitution": 0.85, "amplitude": _all_of(1.0, 1.1, 2.0)},
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
    if isinstance(paper, _Needed):
        # A text where a number is needed is not the paper's.
        with suppress(TypeError):
            return paper.holds(given)
        return False
    # A list of one number is that number among the attributes.
    return _listed(given) == _listed(paper)


class PaperData(Mapping[str, xr.Dataset]):
    """Datasets by name, as far as they have the paper's parameters.

    Taking one that has others raises :class:`NotAsked`; one without a required
    parameter, or none, raises :class:`~bouncing_ball.errors.ModelError`. ``used`` names
    those taken, in their order.
    """

    def __init__(self, data: Mapping[str, xr.Dataset]) -> None:
        self._data = data
        self.used: dict[str, None] = {}

    def __getitem__(self, name: str) -> xr.Dataset:
        if name not in PARAMETERS or name not in self._data:
            raise ModelError(f"no dataset {name}")
        attributes = self._data[name].attrs
        for key, paper in {**COMMON, **PARAMETERS[name]}.items():
            attribute = attribute_name(key)
            if attribute in attributes:
                given = _plain(attributes[attribute])
                if not _agrees(given, paper):
                    raise NotAsked(
                        f"{name} was computed with {key} = {given}; the claim requires {paper}"
                    )
            elif key not in COMMON:
                raise ModelError(f"dataset {name} has no parameter {key}, required: {paper}")
        self.used[name] = None
        return self._data[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)
