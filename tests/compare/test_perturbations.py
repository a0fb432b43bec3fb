"""The diff tests itself: a known change of each kind gives the outcome it should."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.compare.drift import span
from bouncing_ball.compare.outcome import Outcome, status
from bouncing_ball.compare.tolerances import Mode, Tolerance, Tolerances
from bouncing_ball.datasets.netcdf import write_dataset

# Most compare whole folders.
pytestmark = pytest.mark.slow

HALF, TWICE = 0.5, 2.0


def moved(data: xr.Dataset, name: str, index: tuple, by: float) -> xr.Dataset:
    """The dataset with one value of one variable changed."""
    changed = data.copy(deep=True)
    changed[name].values[index] += by
    return changed


def test_equal_folders_are_identical(pair):
    comparison = pair.compare()
    assert {found.outcome for found in comparison.artifacts} == {Outcome.IDENTICAL}
    assert status(comparison.outcome) == 0
    names = {"fig01", "fig05", "fig08", "fig09", "table1", "witness", "paper"}
    assert {found.name for found in comparison.artifacts} == names
    # Every file of both sides was compared.
    files = {part.file for found in comparison.artifacts for part in found.parts}
    paths = (path for path in pair.record.rglob("*") if path.is_file())
    assert files == {path.relative_to(pair.record).as_posix() for path in paths}


# One value of one variable, by 0.5× and 2× its budget, for each mode.


@pytest.mark.parametrize("part", [HALF, TWICE])
def test_pointwise(pair, part):
    data = pair.dataset("fig05")
    budget = pair.rules.of("fig05", "phase").budget
    # Where the phase is next to 0, and a relative error would be meaningless.
    index = tuple(int(k) for k in np.argwhere(np.abs(data.phase.values) < 0.01)[0])
    pair.write("fig05", moved(data, "phase", index, part * budget * span(data.phase)))
    result = pair.variable("fig05", "phase")
    assert result.outcome == (Outcome.WITHIN if part < 1 else Outcome.DRIFTED)
    # One rounding of a phase up to 1.6 against a budget of 1e-13 of the range.
    assert result.share == pytest.approx(part, abs=2e-3)
    ratio = data.frequency_ratio.values[index[1]]
    assert result.place == f"case = {index[0]}, frequency_ratio = {ratio:.6g}"
    artifact = pair.artifact("fig05")
    assert artifact.outcome == result.outcome and artifact.share == result.share


@pytest.mark.parametrize("part", [HALF, TWICE])
def test_curve(pair, part):
    data = pair.dataset("fig08")
    budget = pair.rules.of("fig08", "bounce_velocity").budget
    # On the stiff branch the velocity is nπ everywhere, so that the curve over
    # Λ is level: moved up, a point is as far from it as it has moved.
    index = (0, 300)
    height = part * budget * span(data.bounce_velocity)
    pair.write("fig08", moved(data, "bounce_velocity", index, height))
    result = pair.variable("fig08", "bounce_velocity")
    assert result.outcome == (Outcome.WITHIN if part < 1 else Outcome.DRIFTED)
    # The slope of the level curve, 1e-4, is what is missing to the right angle.
    assert result.share == pytest.approx(part, rel=1e-3)


@pytest.mark.parametrize("part", [HALF, TWICE])
def test_curve_along_its_abscissa(part):
    # Up at x = 0, then level to x = 1: moved to the right, the part that goes
    # up is off by the shift, measured by the budget of the abscissa.
    x, y = np.zeros(21), np.ones(21)
    x[10:], y[:11] = np.linspace(0.0, 1.0, 11), np.linspace(0.0, 1.0, 11)
    record = xr.Dataset({"y": ("k", y)}, coords={"x": ("k", x)})
    new = record.assign_coords(x=("k", x + part * 0.01))
    # Not the same numbers, so that the curves are looked at.
    new["y"] = new.y + 1e-12
    rule = Tolerance(Mode.CURVE, "a test", budget=1e-6, along="k", abscissa="x", axis_budget=0.01)
    loose = Tolerance(Mode.POINTWISE, "a test", budget=1.0)
    rules = Tolerances({"x": loose, "y": rule}, loose)
    found = {result.name: result for result in compare_datasets("", record, new, rules)}
    assert found["y"].outcome is (Outcome.WITHIN if part < 1 else Outcome.DRIFTED)
    assert found["y"].share == pytest.approx(part, rel=1e-9)


@pytest.mark.parametrize("part", [HALF, TWICE])
def test_scale_by_another_variable(pair, part):
    data = pair.dataset("witness")
    index = ("fig08", "continuation and formula")
    at = tuple(
        list(data[dim].values).index(x)
        for dim, x in zip(data.disagreement.dims, index, strict=True)
    )
    before = float(data.disagreement.values[at])
    changed = data.copy(deep=True)
    changed.disagreement.values[at] = before + part * float(data.budget.values[at[1]])
    pair.write("witness", changed)
    result = pair.variable("witness", "disagreement")
    assert result.outcome == (Outcome.WITHIN if part < 1 else Outcome.DRIFTED)
    assert result.share == pytest.approx(part, rel=1e-12)


def test_exact(pair):
    data = pair.dataset("witness")
    pair.write("witness", moved(data, "orbits", (0, 0), 1))
    result = pair.variable("witness", "orbits")
    assert result.outcome is Outcome.DRIFTED and result.share == np.inf
    assert f"1 of {data.orbits.size} entries differ" in result.note


def test_words(pair):
    data = pair.dataset("fig08")
    changed = data.copy(deep=True)
    changed["special_kind"] = data.special_kind.dims, data.special_kind.values.astype("U32")
    changed.special_kind.attrs = data.special_kind.attrs
    changed.special_kind.values[0, 1] = "Neimark-Sacker bifurcation"
    pair.write("fig08", changed)
    result = pair.variable("fig08", "special_kind")
    assert result.outcome is Outcome.DRIFTED
    assert (result.record, result.new) == ("period doubling", "Neimark-Sacker bifurcation")


def test_ignored(pair):
    record = xr.Dataset({"found": ("claim", [1.0, 2.0])}, coords={"claim": ["a", "b"]})
    found = compare_datasets("claims", record, record.assign(found=2 * record.found), pair.rules)
    assert {x.name: x.outcome for x in found} == {
        "found": Outcome.WITHIN,
        "claim": Outcome.IDENTICAL,
    }


def test_stability_at_the_edge_and_elsewhere(pair):
    data = pair.dataset("fig08")
    row = data.stable.values[0]
    edge = int(np.argmax(row != row[0]))
    for sample, outcome in ((edge, Outcome.WITHIN), (edge // 2, Outcome.DRIFTED)):
        changed = data.copy(deep=True)
        changed.stable.values[0, sample] ^= True
        pair.write("fig08", changed)
        assert pair.variable("fig08", "stable").outcome is outcome


# Structure.


def test_points_that_slide_along_the_curve(pair):
    data = pair.dataset("fig09")
    curves = [
        name
        for name in map(str, data.data_vars)
        if (rule := pair.rules.of("fig09", name)).mode == "curve" and rule.abscissa != "point"
    ]
    changed = data.copy(deep=True)
    for name in curves:
        # A ten-thousandth of the way to the next sample, on the parabola through
        # three of them.
        before, middle, after = (data[name].values[:, k] for k in (299, 300, 301))
        t, bend = 1e-4, (after - 2 * middle + before) / 2
        changed[name].values[:, 300] = middle + t * (after - before) / 2 + t * t * bend
    pair.write("fig09", changed)
    found = {result.name: result for result in pair.part("figures/fig09.nc").variables}
    for name in curves:
        assert found[name].outcome.agrees, name
    # Point by point the phase has moved by far more than it may.
    slid = float(np.abs(changed.phase - data.phase).max()) / span(data.phase)
    assert slid > 10 * found["phase"].budget > 10 * found["phase"].drift


def test_shifted_abscissa(pair):
    data = pair.dataset("fig05")
    budget = pair.rules.of("fig05", "frequency_ratio").budget
    for part, outcome in ((HALF, Outcome.WITHIN), (TWICE, Outcome.DRIFTED)):
        ratios = data.frequency_ratio.values.copy()
        ratios[-1] += part * budget * np.ptp(ratios)
        shifted = data.assign_coords(frequency_ratio=data.frequency_ratio.copy(data=ratios))
        shifted.frequency_ratio.attrs = data.frequency_ratio.attrs
        pair.write("fig05", shifted)
        assert pair.variable("fig05", "frequency_ratio").outcome is outcome


def test_other_labels_are_other_data(pair):
    data = pair.dataset("table1")
    pair.write("table1", data.assign_coords(n=data.n.copy(data=[1, 2, 4])))
    result = pair.variable("table1", "n")
    assert result.outcome is Outcome.DRIFTED and (result.record, result.new) == ("3", "4")


def structure(pair, name, data, variable, note, outcome=Outcome.STRUCTURE):
    pair.write(name, data)
    artifact = pair.artifact(name)
    part = next(part for part in artifact.parts if part.file == f"figures/{name}.nc")
    found = {result.name: result for result in part.variables}
    assert found[variable].outcome is outcome
    assert note in found[variable].note
    assert part.outcome is outcome
    assert part.variables[0].outcome is outcome
    assert status(artifact.outcome) == 1


def test_dropped_coordinate(pair):
    dropped = pair.dataset("fig05").drop_vars("frequency_ratio")
    structure(pair, "fig05", dropped, "frequency_ratio", "is gone")


def test_coordinate_turned_into_data(pair):
    data = pair.dataset("table1")
    structure(
        pair, "table1", data.assign_coords(printed=data.printed), "printed", "data → coordinate"
    )
    write_dataset(data.assign_coords(printed=data.printed), pair.record / "figures" / "table1.nc")
    structure(pair, "table1", data, "printed", "coordinate → data")


def test_dropped_and_new_variable(pair):
    data = pair.dataset("fig05")
    structure(pair, "fig05", data.drop_vars("phase"), "phase", "is gone")
    structure(pair, "fig05", data.assign(angle=data.phase), "angle", "is new")


@pytest.mark.parametrize(
    ("variable", "dtype", "note"),
    [("phase", "f4", "float64 → float32"), ("case", "i4", "int64 → int32")],
)
def test_changed_dtype(pair, variable, dtype, note):
    data = pair.dataset("fig05")
    changed = data.assign({variable: data[variable].astype(dtype, keep_attrs=True)})
    structure(pair, "fig05", changed, variable, note)


def test_changed_dimensions(pair):
    data = pair.dataset("fig05")
    shorter = data.isel(frequency_ratio=slice(0, 300))
    structure(pair, "fig05", shorter, "phase", "size of frequency_ratio: 301 → 300")
    turned = data.assign(phase=data.phase.transpose())
    structure(pair, "fig05", turned, "phase", "case, frequency_ratio → frequency_ratio, case")


def test_attributes_that_matter_and_others(pair):
    data = pair.dataset("fig05")
    other = data.assign_attrs(n=2)
    note = "attribute n: 1 → 2"
    structure(pair, "fig05", other, "(global attributes)", note, Outcome.DRIFTED)
    without = data.copy()
    del without.attrs["release"]
    structure(pair, "fig05", without, "(global attributes)", "attribute release is gone")
    units = data.copy(deep=True)
    units.phase.attrs["units"] = "degree"
    structure(pair, "fig05", units, "phase", "attribute units: rad → degree", Outcome.DRIFTED)
    made = {"provenance_commit": "0123abc", "title": "another_rule"}
    pair.write("fig05", data.assign_attrs(made))
    assert pair.artifact("fig05").outcome is Outcome.IDENTICAL


# NaN, infinity, files.


def test_attributes_of_another_kind(pair):
    data = pair.dataset("fig05")
    for value in ("1", [1, 2], 2):
        other = data.assign_attrs(n=value)
        note = f"attribute n: 1 → {value}"
        structure(pair, "fig05", other, "(global attributes)", note, Outcome.DRIFTED)


def test_nan_and_infinity(pair):
    data = pair.dataset("fig05")
    for value, text in ((np.nan, "nan"), (np.inf, "inf")):
        pair.write("fig05", moved(data, "phase", (2, 17), value))
        result = pair.variable("fig05", "phase")
        assert result.outcome is Outcome.DRIFTED and result.drift == np.inf
        assert result.new == text and result.place.startswith("case = 2")
    data = pair.dataset("fig08")
    pair.write("fig08", moved(data, "phase", (1, 17), np.nan))
    found = {result.name: result for result in pair.part("figures/fig08.nc").variables}
    assert found["phase"].outcome is Outcome.DRIFTED
    assert found["phase"].place == "frequency_ratio = 10, point = 17"


def test_nan_in_the_record_that_is_gone(pair):
    data = pair.dataset("fig08")
    there = tuple(int(k) for k in np.argwhere(np.isnan(data.special_phase.values))[0])
    changed = data.copy(deep=True)
    changed.special_phase.values[there] = 0.0
    pair.write("fig08", changed)
    assert pair.variable("fig08", "special_phase").outcome is Outcome.DRIFTED


@pytest.mark.parametrize("kept", [0.0, 0.01, 0.5, 0.95])
def test_truncated_netcdf(pair, kept, capfd):
    path = pair.new / "figures" / "fig05.nc"
    content = path.read_bytes()
    path.write_bytes(content[: int(kept * len(content))])
    part = pair.part("figures/fig05.nc")
    assert part.outcome is Outcome.UNREADABLE and part.note.startswith("new:")
    assert str(pair.new) not in part.note and "\n" not in part.note
    comparison = pair.compare()
    assert comparison.artifacts[0].name == "fig05"
    assert status(comparison.outcome) == 2
    # The others are compared all the same.
    assert {found.outcome for found in comparison.artifacts[1:]} == {Outcome.IDENTICAL}


def test_truncated_record(pair):
    path = pair.record / "figures" / "fig08.nc"
    path.write_bytes(path.read_bytes()[:1000])
    assert pair.part("figures/fig08.nc").note.startswith("record:")


def test_missing_and_extra(pair):
    (pair.new / "figures" / "fig08.png").unlink()
    (pair.record / "figures" / "fig05.svg").unlink()
    (pair.new / "paper.md").unlink()
    for path in (pair.record / "figures").glob("fig09.*"):
        path.unlink()
    for path in (pair.new / "figures").glob("table1.*"):
        path.unlink()
    comparison = pair.compare()
    outcomes = {found.name: found.outcome for found in comparison.artifacts}
    expected = dict.fromkeys(("fig08", "paper", "table1"), Outcome.MISSING)
    expected |= dict.fromkeys(("fig05", "fig09"), Outcome.EXTRA)
    expected |= dict.fromkeys(("fig01", "witness"), Outcome.IDENTICAL)
    assert outcomes == expected
    assert status(comparison.outcome) == 1


def test_labels_that_are_there_twice(pair):
    data = pair.dataset("table1")
    twice = data.assign_coords(n=data.n.copy(data=[1, 1, 1]))
    for name in ("record", "new"):
        write_dataset(twice, getattr(pair, name) / "figures" / "table1.nc")
    assert pair.part("figures/table1.nc").outcome is Outcome.IDENTICAL
    pair.write("table1", moved(twice, "computed", (1, 0, 0), 1.0))
    assert pair.variable("table1", "computed").outcome is Outcome.DRIFTED


def test_a_variable_without_an_entry_is_compared_exactly(pair):
    data = pair.dataset("fig05")
    both = data.assign(novelty=data.phase.drop_attrs())
    write_dataset(both, pair.record / "figures" / "fig05.nc")
    pair.write("fig05", both)
    part = pair.part("figures/fig05.nc")
    assert part.outcome is Outcome.IDENTICAL and part.note == "no entry for novelty"
    pair.write("fig05", moved(both, "novelty", (0, 0), 1e-15))
    part = pair.part("figures/fig05.nc")
    assert part.outcome is Outcome.DRIFTED
    assert part.variables[0].name == "novelty"
    note = f"1 of {both.novelty.size} entries differ; no entry in the tolerance file"
    assert part.variables[0].note == note


def test_the_worst_comes_first(pair):
    data = pair.dataset("fig05")
    pair.write("fig05", moved(data, "phase", (0, 0), 1e-3))
    pair.write("fig09", moved(pair.dataset("fig09"), "phase", (0, 300), 1.0))
    (pair.new / "figures" / "fig01.svg").unlink()
    names = [found.name for found in pair.compare().artifacts]
    # fig05 has drifted by 1e-3 with a budget of 1e-13, fig09 by 1 with 1e-8.
    assert names[:3] == ["fig01", "fig05", "fig09"]
