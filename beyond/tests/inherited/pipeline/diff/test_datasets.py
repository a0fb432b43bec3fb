"""Datasets: a known change of each kind gives the outcome it should."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.datasets.files import read_dataset
from bouncing_ball_beyond.inherited.datasets.variables import ROUNDING
from bouncing_ball_beyond.inherited.pipeline.diff.datasets import (
    budget_of,
    compare_datasets,
    curve_distance,
    pointwise,
    span,
)
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome, Whole


@pytest.fixture(scope="module")
def branches(request):
    """A dataset with branches of orbits, which has the budgets of its artifact."""
    return read_dataset(Path(__file__).with_name("record") / "figures" / "fig09.nc")


def moved(data: xr.Dataset, name: str, index: tuple, by: float) -> xr.Dataset:
    """The dataset with one value of one variable changed."""
    changed = data.copy(deep=True)
    changed[name].values[index] += by
    return changed


def differing(record, new):
    return [row for row in compare_datasets(record, new) if row.outcome is not Outcome.IDENTICAL]


@pytest.mark.parametrize(("part", "outcome"), [(0.5, Outcome.ROUNDING), (2.0, Outcome.DRIFTED)])
@pytest.mark.parametrize(
    "attributes",
    [
        {},
        {"budget": 1e-6},
        {"budget": 1e-6, "scale": "1"},
        {"budget": 1e-6, "scale": "height"},
        {"budget": 1e-6, "over": "height"},
    ],
)
def test_half_a_budget_agrees_and_two_budgets_have_drifted(attributes, part, outcome):
    # Next to 0, where a relative error would be meaningless; over the height the curve is level.
    level = 1.0 if "over" in attributes else 0.0
    record = xr.Dataset(
        {"x": ("point", [-3.0, level, level, level, 5.0], attributes)},
        {"height": ("point", [1.0, 2.0, 3.0, 4.0, 5.0])},
    )
    scale = {"": 8.0, "1": 1.0, "height": 3.0}[attributes.get("scale", "")]
    by = part * attributes.get("budget", ROUNDING) * scale
    (row,) = differing(record, moved(record, "x", (2,), by))
    assert row.outcome is outcome and row.share == pytest.approx(part, abs=2e-3)
    assert "x at point = 2: " in row.told
    # The share of a defect in another one says nothing.
    assert ("% in x" in row.told) is (not attributes.get("scale"))
    assert row.told.endswith(f"; 1 of 5 entries moved, {int(part > 1)} beyond the budget")


@pytest.mark.parametrize(
    ("values", "other"),
    [([1, 2], [1, 3]), ([True, False], [True, True]), (["a", "b"], ["a", "c"])],
)
def test_counts_words_and_choices_may_not_change(values, other):
    record, new = (xr.Dataset({"orbits": ("t", part)}) for part in (values, other))
    (found,) = differing(record, new)
    assert found.outcome is Outcome.DRIFTED and found.share == np.inf
    assert f"orbits at t = 1: {values[1]} → {other[1]}" in found.told


def test_each_changed_word_is_told():
    record, new = (
        xr.Dataset({"verdict": ("claim", words)}, {"claim": ["Eq. 1", "Eq. 2", "Eq. 3"]})
        for words in (["close"] * 3, ["close", "contradicted", ""])
    )
    found = differing(record, new)
    assert [row.told for row in found] == [
        "verdict at claim = Eq. 2: close → contradicted",
        "verdict at claim = Eq. 3: close → nothing",
    ]
    assert all(row.is_words for row in found)


def test_a_variable_with_an_infinite_budget_is_always_within_it():
    record, new = (xr.Dataset({"x": ("t", [0.0, y], {"budget": np.inf})}) for y in (1.0, 2.0))
    (found,) = differing(record, new)
    assert found.outcome is Outcome.ROUNDING


def test_stability_may_change_at_an_edge_and_nowhere_else(branches):
    row = branches.stable.values[0]
    edge = int(np.argmax(row != row[0]))
    for sample, outcome in ((edge, Outcome.ROUNDING), (edge // 2, Outcome.DRIFTED)):
        changed = branches.copy(deep=True)
        changed.stable.values[0, sample] ^= True
        (found,) = differing(branches, changed)
        assert (found.name, found.outcome) == ("stable", outcome)


def test_points_that_slide_along_their_curve_agree(branches):
    data = branches
    curves = [name for name in data.data_vars if budget_of(data[name].attrs).over in data.data_vars]
    changed = data.copy(deep=True)
    for name in curves:
        # A ten-thousandth of the way to the next sample, on the parabola through
        # three of them.
        before, middle, after = (data[name].values[:, k] for k in (299, 300, 301))
        t = 1e-4
        bend = (after - 2 * middle + before) / 2
        changed[name].values[:, 300] = middle + t * (after - before) / 2 + t * t * bend
    found = compare_datasets(data, changed)
    assert len(curves) == 9 and all(row.outcome.agrees for row in found if row.name in curves)
    # Point by point the phase has moved by far more than it may.
    slid = float(np.abs(changed.phase - data.phase).max()) / span(data.phase)
    assert slid > 10 * budget_of(data.phase.attrs).size


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda x: x.drop_vars("x"), "x: float64, t: 2 → nothing"),
        (lambda x: x.assign(angle=x.x), "angle: nothing → float64, t: 2"),
        (
            lambda x: x.assign(x=x.x.astype("f4", keep_attrs=True)),
            "x: float64, t: 2 → float32, t: 2",
        ),
        (lambda x: x.isel(t=slice(1)), "x: float64, t: 2 → float64, t: 1"),
        (lambda x: x.assign_coords(x=x.x), "x: float64, t: 2 → float64, t: 2 (coordinate)"),
        (lambda x: x.assign(x=x.x.assign_attrs(comment="no")), "comment of x nothing → no"),
        (lambda x: x.assign(x=x.x.assign_attrs(units="1")), "units of x rad → 1"),
        (lambda x: x.assign(x=x.x.assign_attrs(budget=1e-2)), "budget of x 1e-10 → 0.01"),
        (lambda x: x.assign_attrs(title="Two"), "title of the dataset One → Two"),
        (lambda x: x.assign_attrs(references=""), "references of the dataset Us → an empty line"),
    ],
)
def test_another_form_of_a_variable_is_a_changed_structure(change, told):
    record = xr.Dataset(
        {"x": ("t", [0.0, 1.0], {"units": "rad", "budget": 1e-10})},
        attrs={"title": "One", "references": "Us"},
    )
    rows = differing(record, change(record))
    assert told in [row.told for row in rows]
    assert {row.outcome for row in rows} == {Outcome.STRUCTURE}


def test_words_come_first_and_then_a_defect_that_exceeds_its_budget():
    def dataset(last, name):
        columns = {
            "height": ("t", [1.0, last], {"budget": 1e-10}),
            "residual": ("t", [0.0, 0.01 * last], {"budget": 1e-12, "scale": "1"}),
            "verdict": ("claim", ["right", "right" if last == 2 else "wrong"]),
        }
        return xr.Dataset(columns, coords={"claim": ["one", name]})

    rows = Whole("", tuple(differing(dataset(2.0, "two"), dataset(3.0, "two")))).moved
    assert [row.name for row in rows] == ["verdict", "residual", "height"]
    new = xr.Dataset(coords={"claim": ["one", "fold", "two"]}).merge(
        dataset(2.0, "two").drop_dims("claim")
    )
    rows = Whole("", tuple(differing(dataset(2.0, "two"), new))).moved
    assert (
        rows[0].told
        == "claim: text, claim: 2 (coordinate) → text, claim: 3 (coordinate); new: fold"
    )


def test_a_budget_that_is_raised_with_the_change_allows_nothing():
    record, new = (
        xr.Dataset({"x": ("t", [0.0, last], {"budget": budget})})
        for last, budget in ((1.0, 1e-10), (1.001, 1e-2))
    )
    assert [row.outcome for row in differing(record, new)] == [Outcome.STRUCTURE, Outcome.DRIFTED]


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("n", "n 1 → 2"),
        ("frequency_ratio__min", "frequency_ratio.min nothing → 2"),
        # Attributes are known by their names, and not by the beginnings of these.
        ("title_wrong", "title_wrong nothing → 2"),
        ("historyX", "historyX nothing → 2"),
        ("provenance_other", "provenance_other nothing → 2"),
    ],
)
def test_other_parameters_come_first_and_moved_numbers_have_no_share(name, told):
    record = xr.Dataset({"x": ("t", [0.0, 1.0]), "y": 1.0}, attrs={"n": 1, "title": "One"})
    first, second = differing(record, moved(record, "x", (0,), 1.0).assign_attrs({name: 2}))
    assert first.told == told and second.name == "x" and second.share == 0
    assert {first.outcome, second.outcome} == {Outcome.PARAMETERS}


def test_a_number_and_the_same_number_as_text_are_other_parameters():
    record, new = (xr.Dataset(attrs={"n": n}) for n in (1, "1"))
    assert [row.told for row in differing(record, new)] == ["n 1 → '1'"]


def test_provenance_is_not_compared():
    record, new = (xr.Dataset(attrs={"provenance_commit": x}) for x in ("1f0e", "2a2a"))
    assert differing(record, new) == []


def test_a_variable_has_one_row_with_its_largest_move():
    record = xr.Dataset({"x": ("t", [0.0, 0.0, 1.0])}, {"t": [1, 2, 3]})
    new = xr.Dataset({"x": ("t", [0.1, 0.2, 1.0])}, {"t": [1, 2, 3]})
    (row,) = differing(record, new)
    count = "2 of 3 entries moved, 2 beyond the budget"
    assert row.told == f"+20 % in x at t = 2: 0 → 0.2; {count}"


# A gap and both infinities among the samples.
NUMBERS = st.lists(
    st.floats(-1e3, 1e3) | st.sampled_from([np.nan, np.inf, -np.inf]), min_size=1, max_size=12
)


@given(NUMBERS)
def test_nothing_has_drifted_from_itself(values):
    x = np.linspace(0, 1, len(values))
    assert not pointwise(values, values, span(values)).any()
    assert not curve_distance(x, values, x, values).any()


@given(NUMBERS, st.integers(0, 11), st.floats(1e-6, 1e3))
def test_a_drift_is_the_move_divided_by_the_scale(values, k, scale):
    k %= len(values)
    other = list(values)
    other[k] = 0.5 if not np.isfinite(values[k]) else values[k] + scale
    found = pointwise(values, other, scale)
    assert found[k] == (np.inf if not np.isfinite(values[k]) else pytest.approx(1, rel=1e-6))
    assert not np.delete(found, k).any()


def test_a_curve_with_another_gap_is_another_curve():
    x = [0.0, 1.0, 2.0]
    y = [0.0, 0.0, 0.0]
    gap = [0.0, np.nan, 0.0]
    for other in ((x, gap), (gap, y)):
        assert curve_distance(x, y, *other)[1] == curve_distance(*other, x, y)[1] == np.inf


@given(st.floats(-3, 3), st.floats(-0.4, 0.4))
def test_a_curve_moved_across_is_off_by_its_distance(slope, shift):
    # y = sx moved up by d is d/√(1 + s²) away from itself, less than two samples on.
    x = np.linspace(0, 10, 101)
    found = curve_distance(x, slope * x, x, slope * x + shift)
    away = abs(shift) / np.hypot(1, slope)
    assert found[50] == pytest.approx(away, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("shift", [-3.5, -3.0, 2.5, 3.0, 3.5])
def test_along_a_straight_curve_three_samples_are_within_reach(shift):
    # Sample k is compared with the chords from sample k - 3 to k + 3.
    x = np.arange(12.0)
    assert curve_distance(x, 0 * x, x + shift, 0 * x)[6] == max(abs(shift) - 3, 0)
