"""Datasets: a known change of each kind gives the outcome it should."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.pipeline.diff.datasets import (
    ARTIFACTS,
    PICTURES,
    budget_of,
    compare_datasets,
    curve,
    pointwise,
    span,
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
def test_a_number_moved_by_a_share_of_its_budget(pair, figure, name, index, part, outcome):
    data = pair.dataset(figure)
    if index is None:
        index = np.unravel_index(np.nanargmin(np.abs(data[name])), data[name].shape)
    budget = budget_of(figure, name)
    scale = data.budget.values[index[1]] if budget.scale == "budget" else span(data[name])
    pair.write(figure, moved(data, name, index, part * budget.size * scale))
    row, artifact = pair.variable(figure, name), pair.artifact(figure)
    # One rounding of a phase up to 1.6 against a budget of 1e-13 of the range.
    assert row.share == artifact.share == pytest.approx(part, abs=2e-3)
    assert row.outcome is artifact.outcome is outcome
    places = [f"{dim} = " for dim in data[name].dims]
    assert [place for place in places if place not in row.at] == []


@pytest.mark.parametrize(
    ("values", "other"),
    [([1, 2], [1, 3]), ([True, False], [True, True]), (["a", "b"], ["a", "c"])],
)
def test_counts_words_and_choices_are_exact(values, other):
    record, new = (xr.Dataset({"orbits": ("t", part)}) for part in (values, other))
    (found,) = compare_datasets("fig", record, new)
    assert found.outcome is Outcome.DRIFTED and found.share == np.inf
    assert (found.record, found.new) == (str(values[1]), str(other[1]))


def test_no_budget_hides_what_a_reader_sees():
    # A tenth of a pixel of a picture of a thousand, but where rounding decides a whole sample.
    # What engines gave is a measurement, and no picture of the run is made of a new one.
    # Where rounding decides about motions there are statistics, with their standard errors.
    motions = {*PICTURES, "ext_basins", "ext_lives"}
    statistics = [budget for name in motions for budget in ARTIFACTS[name].values()]
    assert all(budget.share <= 0.3 and budget.size <= 7 for budget in statistics)
    computed = [own for name, own in ARTIFACTS.items() if name not in ("engines", *motions)]
    budgets = [budget for own in computed for budget in own.values()]
    assert len(budgets) > 20
    assert all(budget.size <= 1e-4 or budget.over == "point" for budget in budgets)


def test_what_another_dataset_holds_is_not_compared():
    attributes = {"budget": np.inf, "scale": ""}
    record = xr.Dataset({"found": ("t", [0.0, 1.0], attributes)}).assign_attrs()
    (found,) = compare_datasets(
        "fig",
        record,
        record.assign(found=2 * record.found.assign_attrs(attributes)).assign(
            found=("t", [0.0, 2.0], attributes)
        ),
    )
    assert found.outcome is Outcome.WITHIN


def test_stability_at_the_edge_and_elsewhere(pair):
    data = pair.dataset("fig08")
    row = data.stable.values[0]
    edge = int(np.argmax(row != row[0]))
    for sample, outcome in ((edge, Outcome.WITHIN), (edge // 2, Outcome.DRIFTED)):
        changed = data.copy(deep=True)
        changed.stable.values[0, sample] ^= True
        pair.write("fig08", changed)
        assert pair.variable("fig08", "stable").outcome is outcome


def test_points_that_slide_along_the_curve(pair):
    data = pair.dataset("fig09")
    curves = [name for name in data.data_vars if budget_of("fig09", name).over in data.data_vars]
    changed = data.copy(deep=True)
    for name in curves:
        # A ten-thousandth of the way to the next sample, on the parabola through
        # three of them.
        before, middle, after = (data[name].values[:, k] for k in (299, 300, 301))
        t, bend = 1e-4, (after - 2 * middle + before) / 2
        changed[name].values[:, 300] = middle + t * (after - before) / 2 + t * t * bend
    found = compare_datasets("fig09", data, changed)
    assert len(curves) == 9 and all(row.outcome.agrees for row in found if row.name in curves)
    # Point by point the phase has moved by far more than it may.
    slid = float(np.abs(changed.phase - data.phase).max()) / span(data.phase)
    assert slid > 10 * budget_of("fig09", "phase").size


@pytest.mark.parametrize(
    ("change", "record", "new"),
    [
        (lambda x: x.drop_vars("phase"), "phase: float64, case: ", None),
        (lambda x: x.assign(angle=x.stable), None, "angle: bool, case: "),
        (
            lambda x: x.assign(phase=x.phase.astype("f4", keep_attrs=True)),
            "phase: float64",
            "phase: float32",
        ),
        (lambda x: x.assign(phase=x.phase.transpose()), "phase: ", "phase: float64, frequency"),
        (lambda x: x.isel(case=slice(2)), "phase: float64, case: ", "phase: float64, case: 2"),
        (lambda x: x.assign_coords(phase=x.phase), "phase: ", "(coordinate)"),
        (lambda x: x.assign_attrs(n=2), "attribute n: 1", "attribute n: 2"),
        (lambda x: x.assign_attrs(n="1"), "attribute n: 1", "attribute n: '1'"),
        (
            lambda x: x.assign(phase=x.phase.assign_attrs(units="degree")),
            "attribute units of phase: 'rad'",
            "attribute units of phase: 'degree'",
        ),
    ],
)
def test_structure_and_attributes(pair, change, record, new):
    data = pair.dataset("fig05")
    found = [x for x in compare_datasets("fig05", data, change(data)) if x.name == "header"]
    assert {row.outcome for row in found} == {Outcome.STRUCTURE}
    for side, said in (("record", record), ("new", new)):
        texts = [getattr(row, side) for row in found]
        assert None in texts if said is None else any(said in text for text in texts)


def test_what_a_file_was_made_with_is_not_compared(pair):
    data = pair.dataset("fig05")
    other = data.assign_attrs(provenance_commit="2a2a", title="Other words")
    assert {row.outcome for row in compare_datasets("fig05", data, other)} == {Outcome.IDENTICAL}


# A gap and both infinities among the samples.
NUMBERS = st.lists(
    st.floats(-1e3, 1e3) | st.sampled_from([np.nan, np.inf, -np.inf]), min_size=2, max_size=12
)


@given(NUMBERS)
def test_nothing_has_drifted_from_itself(values):
    x = np.linspace(0, 1, len(values))
    assert not pointwise(values, values, span(values)).any()
    assert not curve(x, values, x, values).any()


@given(NUMBERS, st.integers(0, 11), st.floats(1e-6, 1e3))
def test_a_drift_is_the_move_over_the_scale(values, k, scale):
    k %= len(values)
    other = list(values)
    other[k] = 0.5 if not np.isfinite(values[k]) else values[k] + scale
    found = pointwise(values, other, scale)
    assert found[k] == (np.inf if not np.isfinite(values[k]) else pytest.approx(1, rel=1e-6))
    assert not np.delete(found, k).any()


def test_a_curve_with_another_gap_is_another_curve():
    x, y, gap = [0.0, 1.0, 2.0], [0.0, 0.0, 0.0], [0.0, np.nan, 0.0]
    for other in ((x, gap), (gap, y)):
        assert curve(x, y, *other)[1] == curve(*other, x, y)[1] == np.inf


@given(st.floats(-3, 3), st.floats(-0.4, 0.4))
def test_a_curve_moved_across_is_off_by_its_distance(slope, shift):
    # y = sx moved up by d is d/√(1 + s²) away from itself, less than two samples on.
    x = np.linspace(0, 10, 101)
    found = curve(x, slope * x, x, slope * x + shift)
    away = abs(shift) / np.hypot(1, slope)
    assert found[50] == pytest.approx(away, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("shift", [-3.5, -3.0, 2.5, 3.0, 3.5])
def test_along_a_straight_curve_three_samples_are_within_reach(shift):
    # Sample k is compared with the chords from sample k - 3 to k + 3.
    x = np.arange(12.0)
    assert curve(x, 0 * x, x + shift, 0 * x)[6] == max(abs(shift) - 3, 0)
