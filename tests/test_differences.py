"""Curves, cases and claims that were added or removed, and parameters that are lists."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball import differences

CASES = ["r = 1, Λ = 0.8", "r = 0.85, Λ = 1", "r = 0.65, Λ = 1"]
NEW = "r = 0.5, Λ = 1.1"


def curves(cases=CASES, points=4) -> xr.Dataset:
    """A curve for each case, which depends on the case and not on its place."""
    ratio = np.linspace(1.0, 10.0, points)
    start = np.array([len(case) + float(case.split()[-1]) for case in cases])
    data = xr.Dataset(
        {"apparent_restitution": (("case", "frequency_ratio"), start[:, np.newaxis] + ratio)},
        {"case": cases, "frequency_ratio": ratio, "amplitude": ("case", start)},
        {"title": "Figure 5", "parameters": "{}"},
    )
    data["apparent_restitution"].attrs = {"tolerance": 1e-9, "floor": 1e-3}
    return data


def texts(new, old):
    found = differences.dataset_differences(new, old)
    return [each.text for each in sorted(found, key=lambda each: each.rank)]


@pytest.mark.parametrize("place", [0, 1, 3])
def test_an_added_or_removed_curve_is_one_finding_and_the_others_are_compared(place):
    more = curves([*CASES[:place], NEW, *CASES[place:]])
    assert texts(more, curves()) == [f"case: new {NEW!r}; the other 3 agree"]
    assert texts(curves(), more) == [f"case: without {NEW!r}; the other 3 agree"]
    more["apparent_restitution"].loc[{"case": CASES[2]}] *= 1.001
    found = texts(more, curves())
    assert f"at case = {CASES[2]!r}" in found[0] and "and 3 more of 12 values" in found[0]
    assert found[1:] == [f"case: new {NEW!r}; the other 3 were compared"]


def test_a_changed_curve_is_the_only_one_that_is_not_compared():
    changed = curves([CASES[0], NEW, CASES[2]])
    words = f"case: new {NEW!r}, without {CASES[1]!r}; the other 2 agree"
    assert texts(changed, curves()) == [words]


def test_more_frequency_ratios_are_compared_where_they_are_the_same():
    assert texts(curves(points=7), curves()) == [
        "frequency_ratio: new 2.5, 5.5, 8.5; the other 4 agree"
    ]
    assert texts(curves(points=13), curves()) == [
        "frequency_ratio: new 1.75, 2.5, 3.25 and 6 more; the other 4 agree"
    ]


def test_numbers_have_as_many_digits_as_tell_them_apart():
    assert differences.legible([0.1 + 0.2, 1 / 3]) == ["0.3", "0.3333"]
    near = differences.legible([0.1 + 0.2, 0.3])
    assert near == ["0.30000000000000004", "0.29999999999999999"]
    assert differences.legible([1.0, 1.0 + 1e-6, np.nan, np.nan]) == ["1", "1.000001", "nan", "nan"]


def test_of_labels_in_another_order_only_the_order_is_different():
    reversed_cases = curves().isel(case=[2, 1, 0])
    assert texts(reversed_cases, curves()) == ["case: the order changed; the 3 agree"]
    reversed_ratios = curves().isel(frequency_ratio=slice(None, None, -1))
    assert texts(reversed_ratios, curves()) == ["frequency_ratio: the order changed; the 4 agree"]
    more = curves([CASES[2], NEW, CASES[0]])
    words = f"case: new {NEW!r}, without {CASES[1]!r}, and the order changed; the other 2 agree"
    assert texts(more, curves()) == [words]
    reversed_cases["apparent_restitution"].loc[{"case": CASES[2]}] *= 1.001
    found = texts(reversed_cases, curves())
    assert f"at case = {CASES[2]!r}" in found[0] and "and 3 more of 12 values" in found[0]
    assert found[1:] == ["case: the order changed; the 3 were compared"]


def test_repeated_or_only_new_labels_do_not_agree():
    repeated = texts(curves([*CASES, CASES[0]]), curves())
    assert "case.dimensions {'case': 3} -> {'case': 4}" in repeated
    another = texts(curves([NEW]), curves(CASES[1:2]))
    assert f"case is {NEW!r}, the reference has {CASES[1]!r} at" in " ".join(another)


def test_transposed_values_are_different():
    words = "{'case': 3, 'frequency_ratio': 4} -> {'frequency_ratio': 4, 'case': 3}"
    line = f"apparent_restitution.dimensions {words}"
    assert texts(curves().transpose(), curves()) == [line]


def test_a_rounded_coordinate_is_no_new_one():
    rounded = curves()
    rounded["frequency_ratio"] = rounded.frequency_ratio * (1 + 1e-15)
    old = curves()
    for data in (rounded, old):
        data.frequency_ratio.attrs = {"tolerance": 1e-9, "floor": 1e-3}
    assert texts(rounded, old) == []


def test_of_a_list_only_what_changed_is_stated():
    old = {"cases": [{"amplitude": 0.8}, {"amplitude": 1.0}], "n": [1, 2]}
    new = {"cases": [{"amplitude": 0.8}, {"amplitude": 1.1}], "n": [1, 2, 3]}
    assert differences.changes(old, new) == [
        "cases: new {'amplitude': 1.1}, without {'amplitude': 1.0}",
        "n: new 3",
    ]
    assert differences.changes({"n": [1, 2]}, {"n": [2, 1]}) == ["n [1, 2] -> [2, 1]"]
