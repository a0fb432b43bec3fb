"""The claims of the paper, and the verdict on each, from the datasets of figures and tables.

A claim is a printed number or a statement. A printed number is compared with the computed one:
*reproduced* if this rounds to it, *not to the digit* if it does not but differs by at most 1 %, and
*contradicted* beyond. A statement is turned into one condition for each way in which its words can
be read. It is *reproduced* or *contradicted* if all of these readings agree, and *by reading* if
they do not: then the verdict names those for which it is right and those for which it is not. It is
*undecidable* if the text lacks what would choose among the readings, and a *definition* if it could
not have failed. The formulas of the paper were *restored* from a damaged text by deriving them
again, and are listed and not counted. A claim is *not asked* if a dataset was computed with other
parameters than the claim needs, and *not computed* if a dataset or a number is missing.
"""

import csv
import json
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from bouncing_ball import restitution
from bouncing_ball.spring_damper import Contact, damping_ratio, permanent_contact

LIMIT = 0.01
"""The error of the restitution model that the paper allows, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""The frequency ratio above which the paper calls both models equal."""
ROUNDING = 1e-9
"""Numbers that differ by less are equal: rounding errors of the datasets are some 1e-12."""

LOW_TO_STIFF = {"min": 1.0, "max": 1000.0}
ROWS_OF_TABLE_1 = [1e4, 10.0, 2.0]
PAPER = {
    "fig03": {"n": [1, 2, 3, 4, 5], "restitution": 0.85},
    "fig05": {
        "n": 1,
        "cases": [
            {"restitution": 1.0, "amplitude": 0.8},
            {"restitution": 0.85, "amplitude": 1.0},
            {"restitution": 0.65, "amplitude": 1.0},
            {"restitution": 0.1, "amplitude": 2.6},
        ],
        "frequency_ratio": LOW_TO_STIFF,
        "release": "displacement",
    },
    "fig06": {
        "n": 1,
        "cases": [
            {"restitution": 0.65, "amplitude": 0.7},
            {"restitution": 0.65, "amplitude": 1.0},
            {"restitution": 0.65, "amplitude": 1.2},
        ],
        "frequency_ratio": LOW_TO_STIFF,
        "release": "displacement",
    },
    "fig08": {
        "n": 1,
        "restitution": 0.85,
        "frequency_ratio": ROWS_OF_TABLE_1,
        "release": "displacement",
    },
    "fig09": {
        "n": 2,
        "restitution": 0.85,
        "frequency_ratio": ROWS_OF_TABLE_1,
        "release": "displacement",
    },
    "fig10": {
        "n": 2,
        "restitution": 0.85,
        "amplitude": [1.1, 1.0, 0.6],
        "frequency_ratio": LOW_TO_STIFF,
        "release": "displacement",
    },
    "fig11": {
        "restitution": 0.65,
        "frequency_ratio": {"min": 0.5, "max": 100.0},
        "release": "displacement",
    },
    "fig12": {"n": 1, "restitution": 0.65, "amplitude": 1.0, "release": "displacement"},
    "fig13": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": [1.0],
        "frequency_ratio": LOW_TO_STIFF,
        "release": "displacement",
    },
    "fig14": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "frequency_ratio": LOW_TO_STIFF,
        "tolerance": 0.01,
        "release": "displacement",
    },
    "fig15": {"n": 2, "restitution": 0.65, "frequency_ratio": 10.0, "release": "displacement"},
    "fig16": {
        "restitution": 0.65,
        "frequency_ratio": {"min": 0.5, "max": 100.0},
        "tolerance": 0.01,
        "release": "displacement",
    },
    "table1": {
        "n": [1, 2, 3],
        "restitution": 0.85,
        "frequency_ratio": ROWS_OF_TABLE_1,
        "release": "displacement",
    },
    "thresholds": {
        "n": 1,
        "restitution": 0.65,
        "amplitude": 1.0,
        "frequency_ratio": {"min": 1.0, "max": 1e4},
        "release": "displacement",
    },
    "lowest_doubling": {"n": [1, 2, 3], "restitution": 0.85, "release": "displacement"},
}
"""The parameters that the claims need of each dataset: those of the paper, and where its axes
cannot be read, the ends of the ranges to which the conditions refer. The three balls may have any.
"""

QUANTITIES = {
    "max_height": "greatest height",
    "bounce_velocity": "bouncing-off velocity",
    "phase": "phase of impact",
    "apparent_restitution": "apparent restitution coefficient",
    "saddle_node": "Λ of the saddle-node",
    "period_doubling": "Λ of the period doubling",
    "permanent_contact": "Λ of permanent contact",
}
"""Names of the quantities whose error is scanned."""

VERDICTS = (
    "reproduced",
    "definition",
    "by reading",
    "not to the digit",
    "contradicted",
    "undecidable",
    "not asked",
    "not computed",
)
GROUPS = ("printed number", "statement")


# Numbers and conditions


class Comparison(NamedTuple):
    """A computed number beside a printed one: the verdict, and the distance in units of the last
    printed digit and as a share of the printed number.
    """

    verdict: str
    units: float
    share: float


def against_print(found: float, printed: str) -> Comparison:
    """The verdict on a printed number, of which the text has the digits.

    A number halfway between two roundings counts as rounding to either.

    >>> [against_print(found, "0.255").verdict for found in (0.2545, 0.2570, 0.2580)]
    ['reproduced', 'not to the digit', 'contradicted']
    """
    decimals = len(printed.partition(".")[2])
    distance = found - float(printed)
    units = distance * 10.0**decimals
    share = distance / abs(float(printed))
    if np.isnan(found):
        verdict = "not computed"
    elif abs(units) <= 0.5 + ROUNDING:
        verdict = "reproduced"
    elif abs(share) <= LIMIT + ROUNDING:
        verdict = "not to the digit"
    else:
        verdict = "contradicted"
    return Comparison(verdict, units, share)


def distance_text(units: float, share: float) -> str:
    """A distance from a printed number in words; empty if there is none.

    >>> distance_text(6.3, 0.0061)
    '+6.3 units, +0.61 %'
    """
    return "" if np.isnan(units) else f"{units:+.1f} units, {100 * share:+.2f} %"


def markdown(rows: list[list[str]]) -> str:
    """Rows as a Markdown table; the first is the header."""
    header, *body = rows
    lines = [header, ["---"] * len(header), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def parameters(data: xr.Dataset) -> dict:
    """The parameters with which a dataset was computed."""
    return json.loads(data.attrs.get("parameters", "{}"))


def other_parameters(name: str, data: xr.Dataset) -> str:
    """What differs from the parameters that the claims need of a dataset; empty if nothing does."""
    given = parameters(data)
    return "; ".join(
        f"{name}: {key} is {given.get(key)}, and the claim needs {needed}"
        for key, needed in PAPER.get(name, {}).items()
        if not agrees(given.get(key), needed)
    )


def agrees(given, needed) -> bool:
    """Whether a parameter is the needed one; of a range only the needed keys count."""
    if isinstance(needed, Mapping) and isinstance(given, Mapping):
        return all(agrees(given.get(key), value) for key, value in needed.items())
    return given == needed
