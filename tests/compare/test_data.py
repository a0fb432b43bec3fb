"""Datasets: a known change of each kind gives the outcome it should."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.compare.data import compare_datasets, shares
from bouncing_ball.compare.drift import curve, pointwise, span
from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.datasets.variables import Budget, budget_of
from bouncing_ball.errors import ModelError

HALF, TWICE = 0.5, 2.0
BOTH = pytest.mark.parametrize("part", [HALF, TWICE])


def expected(part: float) -> Outcome:
    return Outcome.WITHIN if part < 1 else Outcome.DRIFTED


def moved(data: xr.Dataset, name: str, index: tuple, by: float) -> xr.Dataset:
    """The dataset with one value of one variable changed."""
    changed = data.copy(deep=True)
    changed[name].values[index] += by
    return changed


@BOTH
def test_pointwise_over_the_range(pair, part):
    data = pair.dataset("fig05")
    # Where the phase is next to 0, and a relative error would be meaningless.
    index = tuple(int(k) for k in np.argwhere(np.abs(data.phase.values) < 0.01)[0])
    budget = budget_of("fig05", "phase").size
    pair.write("fig05", moved(data, "phase", index, part * budget * span(data.phase)))
    result = pair.variable("fig05", "phase")
    assert result.outcome is expected(part)
    # One rounding of a phase up to 1.6 against a budget of 1e-13 of the range.
    assert result.share == pytest.approx(part, abs=2e-3)
    ratio = data.frequency_ratio.values[index[1]]
    assert result.at == f"case = {index[0]}, frequency_ratio = {ratio:.6g}"
    artifact = pair.artifact("fig05")
    assert artifact.outcome is result.outcome and artifact.share == result.share


@BOTH
def test_a_curve(pair, part):
    data = pair.dataset("fig08")
    # On the stiff branch the velocity is nπ everywhere, so that the curve over
    # Λ is level: moved up, a point is as far from it as it has moved.
    height = part * budget_of("fig08", "bounce_velocity").size * span(data.bounce_velocity)
    pair.write("fig08", moved(data, "bounce_velocity", (0, 300), height))
    result = pair.variable("fig08", "bounce_velocity")
    assert result.outcome is expected(part)
    # The slope of the level curve, 1e-4, is what is missing to the right angle.
    assert result.share == pytest.approx(part, rel=1e-3)


@BOTH
def test_over_another_variable(pair, part):
    data = pair.dataset("witness")
    at = (0, 0)
    changed = data.copy(deep=True)
    changed.disagreement.values[at] += part * float(data.budget.values[at[1]])
    pair.write("witness", changed)
    result = pair.variable("witness", "disagreement")
    assert result.outcome is expected(part)
    assert result.share == pytest.approx(part, rel=1e-9)


@pytest.mark.parametrize(
    ("values", "other"),
    [([1, 2], [1, 3]), ([True, False], [True, True]), (["a", "b"], ["a", "c"])],
)
def test_counts_words_and_choices_are_exact(values, other):
    record, new = (xr.Dataset({"orbits": ("t", part)}) for part in (values, other))
    (found,) = compare_datasets("fig", record, new)
    assert found.outcome is Outcome.DRIFTED and found.share == np.inf
    assert (found.record, found.new) == (str(values[1]), str(other[1]))


def test_an_unknown_variable_is_exact_and_a_known_number_is_not():
    record = xr.Dataset({"phase": ("t", [0.0, 1.0]), "unheard": ("t", [0.0, 1.0])})
    found = {x.where: x.outcome for x in compare_datasets("fig", record, record + 2.0**-45)}
    assert found == {"phase": Outcome.WITHIN, "unheard": Outcome.DRIFTED}


def test_what_another_dataset_holds_is_not_compared():
    record = xr.Dataset({"found": ("claim", [1.0, 2.0])}, coords={"claim": ["a", "b"]})
    found = compare_datasets("claims", record, record.assign(found=2 * record.found))
    outcomes = {x.where: x.outcome for x in found}
    assert outcomes == {"found": Outcome.WITHIN, "claim": Outcome.IDENTICAL}


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
    curves = [
        name
        for name in map(str, data.data_vars)
        if budget_of("fig09", name).over not in ("", "point")
    ]
    changed = data.copy(deep=True)
    for name in curves:
        # A ten-thousandth of the way to the next sample, on the parabola through
        # three of them.
        before, middle, after = (data[name].values[:, k] for k in (299, 300, 301))
        t, bend = 1e-4, (after - 2 * middle + before) / 2
        changed[name].values[:, 300] = middle + t * (after - before) / 2 + t * t * bend
    found = compare_datasets("fig09", data, changed)
    assert len(curves) == 9 and all(row.outcome.agrees for row in found if row.where in curves)
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
    found = [x for x in compare_datasets("fig05", data, change(data)) if x.where == "header"]
    assert {row.outcome for row in found} == {Outcome.STRUCTURE}
    for side, said in (("record", record), ("new", new)):
        texts = [getattr(row, side) for row in found]
        assert None in texts if said is None else any(said in text for text in texts)


def test_what_a_file_was_made_with_is_not_compared(pair):
    data = pair.dataset("fig05")
    other = data.assign_attrs(provenance_commit="2a2a", title="Other words")
    assert {row.outcome for row in compare_datasets("fig05", data, other)} == {Outcome.IDENTICAL}


def test_a_budget_over_what_is_not_there(pair):
    data = pair.dataset("fig08")
    with pytest.raises(ModelError, match="needs the dimension point"):
        compare_datasets("fig08", data.isel(point=5), moved(data.isel(point=5), "phase", (0,), 1))
    sides = (x.drop_vars("amplitude") for x in (data, moved(data, "phase", (0, 0), 1e-3)))
    with pytest.raises(ModelError, match="needs amplitude"):
        compare_datasets("fig08", *sides)


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


@given(st.floats(-3, 3), st.floats(-0.4, 0.4))
def test_a_curve_moved_across_is_off_by_its_distance(slope, shift):
    # y = sx moved up by d is d/√(1 + s²) away from itself, less than two samples on.
    x = np.linspace(0, 10, 101)
    found = curve(x, slope * x, x, slope * x + shift)
    away = abs(shift) / np.hypot(1, slope)
    assert found[50] == pytest.approx(away, rel=1e-9, abs=1e-12)


def test_shares_are_drifts_over_the_budget():
    record = xr.Dataset({"y": ("point", [0.0, 1.0, 2.0]), "x": ("point", [0.0, 1.0, 2.0])})
    new = record.assign(y=record.y + 0.5)
    assert shares("y", record, new, Budget(0.5, scale=2.0)).tolist() == [0.5] * 3
    assert shares("y", record, new, Budget(0.25, over="x")).tolist() == pytest.approx(
        [0.5**0.5] * 3, abs=0.3
    )
    assert shares("y", record, new, None).tolist() == [np.inf] * 3
