"""Datasets: a known change of each kind gives the outcome it should."""

from hashlib import sha256

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.pipeline.diff.budgets import (
    ARTIFACTS,
    PICTURE,
    PIXEL,
    ROUNDING,
    budget_of,
)
from bouncing_ball.pipeline.diff.datasets import (
    compare_datasets,
    curve_distance,
    pointwise,
    span,
    word_rows,
)
from bouncing_ball.pipeline.diff.outcome import Outcome


def moved(data: xr.Dataset, name: str, index: tuple, by: float) -> xr.Dataset:
    """The dataset with one value of one variable changed."""
    changed = data.copy(deep=True)
    changed[name].values[index] += by
    return changed


@pytest.mark.parametrize(("part", "outcome"), [(0.5, Outcome.WITHIN), (2.0, Outcome.DRIFTED)])
@pytest.mark.parametrize(
    ("figure", "name", "index"),
    [
        # Next to 0, where a relative error would be meaningless.
        ("fig05", "phase", None),
        # On the stiff branch the velocity is nπ everywhere, so that the curve over Λ is level:
        # moved up, a point is as far from it as it has moved.
        ("fig08", "bounce_velocity", (0, 300)),
        # Over another variable.
        ("witness", "disagreement", (0, 0)),
    ],
)
def test_half_a_budget_agrees_and_two_budgets_have_drifted(
    pair, figure, name, index, part, outcome
):
    data = pair.dataset(figure)
    if index is None:
        index = np.unravel_index(np.nanargmin(np.abs(data[name])), data[name].shape)
    budget = budget_of(figure, name, data[name].attrs)
    scale = data.budget.values[index[1]] if budget.scale == "budget" else span(data[name])
    pair.write(figure, moved(data, name, index, part * budget.size * scale))
    row = pair.variable(figure, name)
    artifact = pair.artifact(figure)
    # One rounding of a phase up to 1.6 against a budget of 1e-13 of the range.
    assert row.share == artifact.share == pytest.approx(part, abs=2e-3)
    assert row.outcome is artifact.outcome is outcome
    assert all(f"{dim} = " in row.at for dim in data[name].dims)
    assert (row.moved, row.beyond, row.entries) == (1, int(part > 1), data[name].size)


@pytest.mark.parametrize(
    ("values", "other"),
    [([1, 2], [1, 3]), ([True, False], [True, True]), (["a", "b"], ["a", "c"])],
)
def test_counts_words_and_choices_may_not_change(values, other):
    record, new = (xr.Dataset({"orbits": ("t", part)}) for part in (values, other))
    (found,) = compare_datasets("fig", record, new)
    assert found.outcome is Outcome.DRIFTED and found.share == np.inf
    assert (found.record, found.new) == (str(values[1]), str(other[1]))


def test_no_budget_hides_what_a_reader_sees():
    # A tenth of a pixel of a picture of a thousand, but where rounding decides a whole sample.
    # What engines gave is a measurement, and no picture of the run is made of a new one.
    computed = [own for name, own in ARTIFACTS.items() if name != "engines"]
    budgets = [budget for own in computed for budget in own.values()]
    assert len(budgets) > 20
    assert all(budget.size <= 1e-4 or budget.over in ("point", "long_point") for budget in budgets)


def test_a_variable_with_an_infinite_budget_is_always_within_it():
    attributes = {"budget": np.inf, "scale": ""}
    record, new = (xr.Dataset({"found": ("t", [0.0, last], attributes)}) for last in (1.0, 2.0))
    (found,) = compare_datasets("fig", record, new)
    assert found.outcome is Outcome.WITHIN


def test_stability_may_change_at_an_edge_and_nowhere_else(pair):
    data = pair.dataset("fig08")
    row = data.stable.values[0]
    edge = int(np.argmax(row != row[0]))
    for sample, outcome in ((edge, Outcome.WITHIN), (edge // 2, Outcome.DRIFTED)):
        changed = data.copy(deep=True)
        changed.stable.values[0, sample] ^= True
        pair.write("fig08", changed)
        assert pair.variable("fig08", "stable").outcome is outcome


def test_points_that_slide_along_their_curve_agree(pair):
    data = pair.dataset("fig09")
    curves = [name for name in data.data_vars if budget_of("fig09", name).over in data.data_vars]
    changed = data.copy(deep=True)
    for name in curves:
        # A ten-thousandth of the way to the next sample, on the parabola through
        # three of them.
        before, middle, after = (data[name].values[:, k] for k in (299, 300, 301))
        t = 1e-4
        bend = (after - 2 * middle + before) / 2
        changed[name].values[:, 300] = middle + t * (after - before) / 2 + t * t * bend
    found = compare_datasets("fig09", data, changed)
    assert len(curves) == 9 and all(row.outcome.agrees for row in found if row.name in curves)
    # Point by point the phase has moved by far more than it may.
    slid = float(np.abs(changed.phase - data.phase).max()) / span(data.phase)
    assert slid > 10 * budget_of("fig09", "phase").size


@pytest.mark.parametrize(
    ("change", "name", "record", "new"),
    [
        (lambda x: x.drop_vars("phase"), "phase", "float64, case: ", None),
        (lambda x: x.assign(angle=x.stable), "angle", None, "bool, case: "),
        (
            lambda x: x.assign(phase=x.phase.astype("f4", keep_attrs=True)),
            "phase",
            "float64",
            "float32",
        ),
        (lambda x: x.assign(phase=x.phase.transpose()), "phase", "float64, case", "float64, freq"),
        (lambda x: x.isel(case=slice(2)), "phase", "float64, case: ", "float64, case: 2"),
        (lambda x: x.assign_coords(phase=x.phase), "phase", "float64", "(coordinate)"),
        (
            lambda x: x.assign(phase=x.phase.assign_attrs(comment="a word")),
            "comment of phase",
            None,
            "'a word'",
        ),
        (
            lambda x: x.assign(phase=x.phase.assign_attrs(units="degree")),
            "units of phase",
            "'rad'",
            "'degree'",
        ),
    ],
)
def test_another_form_of_a_variable_is_a_changed_structure(pair, change, name, record, new):
    data = pair.dataset("fig05")
    rows = compare_datasets("fig05", data, change(data))
    assert Outcome.STRUCTURE in {row.outcome for row in rows}
    (row,) = [row for row in rows if row.name == name and row.outcome is Outcome.STRUCTURE]
    for shown, expected in ((row.record, record), (row.new, new)):
        assert shown is None if expected is None else expected in shown


def test_other_parameters_come_first_and_moved_numbers_have_no_share(pair):
    data = pair.dataset("fig05")
    new = moved(data, "phase", (0, 3), 1.0).assign_attrs(n=2)
    first, *others = compare_datasets("fig05", data, new)
    assert (first.name, first.record, first.new) == ("parameter n", "1", "2")
    (phase,) = [row for row in others if row.outcome is not Outcome.IDENTICAL]
    assert phase.name == "phase" and phase.share == 0 and phase.moved == 1
    assert {first.outcome, phase.outcome} == {Outcome.PARAMETERS}


def test_a_number_and_the_same_number_as_text_are_other_parameters(pair):
    data = pair.dataset("fig05")
    row = compare_datasets("fig05", data, data.assign_attrs(n="1"))[0]
    assert (row.outcome, row.record, row.new) == (Outcome.PARAMETERS, "1", "'1'")


def test_a_variable_has_one_row_with_its_largest_move():
    record = xr.Dataset({"x": ("t", [0.0, 0.0, 1.0])}, {"t": [1, 2, 3]})
    new = xr.Dataset({"x": ("t", [0.1, 0.2, 1.0])}, {"t": [1, 2, 3]})
    row, _ = compare_datasets("fig", record, new)
    assert (row.name, row.at, row.record, row.new) == ("x", "t = 2", "0.0", "0.2")
    assert (row.moved, row.beyond, row.entries) == (2, 2, 3)


def test_provenance_is_not_compared_and_words_about_the_dataset_are(pair):
    data = pair.dataset("fig05")
    other = data.assign_attrs(provenance_commit="2a2a")
    assert {row.outcome for row in compare_datasets("fig05", data, other)} == {Outcome.IDENTICAL}
    for name in ("title", "references"):
        (row,) = word_rows(data, data.assign_attrs({name: "Other words"}))
        assert (row.name, row.outcome) == (f"{name} of the dataset", Outcome.STRUCTURE)
        assert row.new == "'Other words'"


def test_a_budget_that_is_raised_with_the_change_is_reported():
    record, new = (
        xr.Dataset({"x": ("t", [0.0, last], {"budget": budget})})
        for last, budget in ((1.0, 1e-10), (1.001, 1e-2))
    )
    budget, values = compare_datasets("fig", record, new)
    assert (budget.name, budget.record, budget.new) == ("budget of x", "1e-10", "0.01")
    assert budget.outcome is Outcome.STRUCTURE and values.outcome is Outcome.WITHIN


def test_the_budgets_of_single_artifacts_are_those_that_were_agreed():
    # They are no attributes of a dataset. Whoever raises one has to say so here as well.
    table = repr((ROUNDING, PICTURE, PIXEL, ARTIFACTS))
    assert sha256(table.encode()).hexdigest()[:12] == "10306aacc514"


# A gap and both infinities among the samples.
NUMBERS = st.lists(
    st.floats(-1e3, 1e3) | st.sampled_from([np.nan, np.inf, -np.inf]), min_size=2, max_size=12
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
