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
    assert result.largest[0].place == f"case = {index[0]}, frequency_ratio = {ratio:.6g}"
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
    assert (found.largest[0].record, found.largest[0].new) == (str(values[1]), str(other[1]))


def test_an_unknown_variable_is_exact_and_a_known_number_is_not():
    record = xr.Dataset({"phase": ("t", [0.0, 1.0]), "unheard": ("t", [0.0, 1.0])})
    found = {x.name: x.outcome for x in compare_datasets("fig", record, record + 2.0**-45)}
    assert found == {"phase": Outcome.WITHIN, "unheard": Outcome.DRIFTED}


def test_what_another_dataset_holds_is_not_compared():
    record = xr.Dataset({"found": ("claim", [1.0, 2.0])}, coords={"claim": ["a", "b"]})
    found = compare_datasets("claims", record, record.assign(found=2 * record.found))
    outcomes = {x.name: x.outcome for x in found}
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
    found = {result.name: result for result in compare_datasets("fig09", data, changed)}
    assert len(curves) == 9 and all(found[name].outcome.agrees for name in curves)
    # Point by point the phase has moved by far more than it may.
    slid = float(np.abs(changed.phase - data.phase).max()) / span(data.phase)
    assert slid > 10 * budget_of("fig09", "phase").size


@pytest.mark.parametrize(
    ("change", "variable", "note"),
    [
        (lambda x: x.drop_vars("phase"), "phase", "is gone"),
        (lambda x: x.assign(angle=x.phase), "angle", "is new"),
        (lambda x: x.drop_vars("frequency_ratio"), "frequency_ratio", "is gone"),
        (
            lambda x: x.assign(phase=x.phase.astype("f4", keep_attrs=True)),
            "phase",
            "type: float64 → float32",
        ),
        (lambda x: x.assign(phase=x.phase.transpose()), "phase", "dimensions: "),
        (lambda x: x.isel(frequency_ratio=slice(300)), "phase", "sizes: "),
        (lambda x: x.assign_coords(phase=x.phase), "phase", "a coordinate: False → True"),
    ],
)
def test_structure(pair, change, variable, note):
    data = pair.dataset("fig05")
    results = compare_datasets("fig05", data, change(data))
    found = {result.name: result for result in results}[variable]
    assert found.outcome is results[0].outcome is Outcome.STRUCTURE
    assert note in found.note


def test_attributes_that_matter_and_others(pair):
    data = pair.dataset("fig05")
    for value in (2, "1", [1, 2]):
        (first, *_) = compare_datasets("fig05", data, data.assign_attrs(n=value))
        assert first.outcome is Outcome.DRIFTED
        assert (first.name, first.note) == ("(global attributes)", f"attribute n: 1 → {value}")
    units = data.copy(deep=True)
    units.phase.attrs["units"] = "degree"
    (first, *_) = compare_datasets("fig05", data, units)
    assert (first.name, first.note) == ("phase", "attribute units: rad → degree")
    made = data.assign_attrs(provenance_commit="0123abc", title="another_rule")
    assert {each.outcome for each in compare_datasets("fig05", data, made)} == {"identical"}


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("name", ["fig05", "fig08"])
def test_a_number_that_is_none(pair, name, value):
    data = pair.dataset(name)
    for record, new in ((data, moved(data, "phase", (1, 17), value)),) * 2:
        for one, other in ((record, new), (new, record)):
            found = {each.name: each for each in compare_datasets(name, one, other)}["phase"]
            assert found.outcome is Outcome.DRIFTED and found.share == np.inf
            assert "17" in found.largest[0].place or "case = 1" in found.largest[0].place


def test_a_budget_over_what_is_not_there(pair):
    data = pair.dataset("fig08")
    other = moved(data.isel(point=5), "phase", (0,), 1e-3)
    found = {x.name: x for x in compare_datasets("fig08", data.isel(point=5), other)}["phase"]
    assert found.outcome is Outcome.STRUCTURE and "needs the dimension point" in found.note
    other = moved(data, "phase", (0, 0), 1e-3)
    sides = (each.drop_vars("amplitude") for each in (data, other))
    found = {x.name: x for x in compare_datasets("fig08", *sides)}["phase"]
    assert found.outcome is Outcome.STRUCTURE and "needs amplitude" in found.note


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
