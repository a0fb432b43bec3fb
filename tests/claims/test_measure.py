"""The number that a measure names, and what is missing in one line."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.claims.ledger import Measure
from bouncing_ball.claims.measure import measured
from bouncing_ball.errors import ModelError

GRID = xr.Dataset(
    {
        "x": (("n", "bound"), [[1.0, 2.0], [3.0, -4.0]]),
        "gap": ("n", [1.0, np.nan]),
        "limit": ("n", [np.inf, 2.0]),
        "stable": ("n", [True, False]),
        "kind": ("n", ["a", "b"]),
        "empty": ("none", np.empty(0)),
    },
    coords={"n": [1, 2], "bound": ["low", "high"], "ratio": ("ratio", [10.0, 10.0])},
).assign(twice=("ratio", [1.0, 2.0]))
DATA = {"grid": GRID}


def take(variable, reduce="value", **at):
    return measured(Measure("grid", variable, tuple(at.items()), reduce), DATA)


def test_a_place_by_number_and_by_name():
    assert take("x", n=2, bound="high") == -4.0
    # In whichever order; and a number is met to rounding.
    assert take("x", bound="low", n=1 + 1e-12) == 1.0


def test_what_is_left_is_reduced():
    assert take("x", "max") == 3.0
    assert take("x", "min") == -4.0
    assert take("x", "sum") == 2.0
    assert take("x", "max", bound="high") == 2.0


def test_flags_count_and_infinity_is_a_number():
    assert take("stable", "sum") == 1.0
    assert take("limit", "max") == np.inf
    assert take("limit", "min") == 2.0


@pytest.mark.parametrize(
    ("measure", "said"),
    [
        (Measure("none", "x"), "no dataset none"),
        (Measure("grid", "y"), "grid has no variable y"),
        (Measure("grid", "x", (("m", 1),)), "x has no coordinate m"),
        (Measure("grid", "x", (("n", 3),)), "n = 3 is not among 1, 2"),
        (Measure("grid", "x", (("n", 1.001),)), "n = 1.001 is not among 1, 2"),
        (Measure("grid", "x", (("bound", "middle"),)), "bound = middle is not among low, high"),
        (Measure("grid", "x", (("bound", 1),)), "bound = 1 is not among low, high"),
        (Measure("grid", "x", (("n", "one"),)), "n = one is not among 1, 2"),
        (Measure("grid", "x", (("n", 1), ("n", 1))), "x has no coordinate n"),
        (Measure("grid", "twice", (("ratio", 10.0),)), "ratio = 10.0 is 2 times among"),
        (Measure("grid", "x"), "4 numbers over n, bound, not 1"),
        (Measure("grid", "x", (("n", 1),)), "2 numbers over bound, not 1"),
        (Measure("grid", "gap", (("n", 2),)), "1 of 1 not a number"),
        # Not skipped by a reduction either.
        (Measure("grid", "gap", (), "max"), "1 of 2 not a number"),
        (Measure("grid", "gap", (), "min"), "1 of 2 not a number"),
        (Measure("grid", "gap", (), "sum"), "1 of 2 not a number"),
        (Measure("grid", "empty", (), "max"), "no numbers over none"),
        (Measure("grid", "kind", (("n", 1),)), "kind does not hold numbers"),
    ],
)
def test_what_is_missing_is_one_line_that_names_the_measure(measure, said, one_line):
    with pytest.raises(ModelError) as error:
        measured(measure, DATA)
    one_line(error, f"{measure}: ", said)
