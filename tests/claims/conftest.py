"""A small ledger and datasets that decide it, for tests to change."""

import copy

import pytest
import xarray as xr

from bouncing_ball.claims.ledger_file import parse_ledger

NUMBER = {
    "id": "height",
    "kind": "number",
    "section": "Results",
    "item": "Fig. 14",
    "statement": "the threshold",
    "printed": "82",
    "legibility": "clear",
    "decided_by": {"dataset": "fig", "variable": "threshold"},
}
STATEMENT = {
    "id": "rises",
    "kind": "statement",
    "section": "Results",
    "item": "Fig. 14",
    "statement": "the height rises",
    "condition": {"text": "it rises everywhere", "above": "0"},
    "legibility": "damaged",
    "remark": "restored",
    "decided_by": {"dataset": "fig", "variable": "rise", "reduce": "min"},
    "explanation": "it turns",
}
TURNS = {
    "id": "it turns",
    "text": "It sinks first.",
    "checks": [
        {
            "decided_by": {"dataset": "fig", "variable": "rise", "at": {"n": 2}},
            "condition": {"below": "0"},
        }
    ],
}


@pytest.fixture
def number():
    """A claim with a printed number, as in the file."""
    return copy.deepcopy(NUMBER)


@pytest.fixture
def statement():
    """A claim in words, with an explanation."""
    return copy.deepcopy(STATEMENT)


@pytest.fixture
def turns():
    """The explanation of the statement."""
    return copy.deepcopy(TURNS)


@pytest.fixture
def ledger():
    """Builds a ledger from claims, explanations and parameters."""

    def build(*claims, explanations=(TURNS,), parameters=None):
        return parse_ledger(
            {
                "close_units": 2,
                "parameters": parameters or {},
                "claims": list(claims),
                "explanations": list(explanations),
            }
        )

    return build


@pytest.fixture
def data():
    """One dataset: a threshold that reproduces 82, and rises of which one is negative."""
    fig = xr.Dataset(
        {"threshold": ((), 82.18), "rise": ("n", [0.5, -0.25, 1.0])},
        coords={"n": [1, 2, 3]},
        attrs={"n": 1, "restitution": 0.65},
    )
    return {"fig": fig}
