"""The scripts of the workflow: what they compute, and that they write what a rule gives them.

Each is run as Snakemake runs it, with the lists of files and parameters of its rule. That the
numbers of a whole run are those of the reference is for `make replication` to say.
"""

import importlib.util
import json
import runpy
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
import yaml
from snakemake.iocontainers import Namedlist
from tests import independent

from bouncing_ball import claims, tables
from bouncing_ball.continuation import branch
from bouncing_ball.datasets import parameters, printed_table, read
from bouncing_ball.history import contents
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact, damping_ratio
from bouncing_ball.verdicts import against_print

ROOT = Path(__file__).parents[1]
SCRIPTS = ROOT / "workflow" / "scripts"
REFERENCE = ROOT / "figures"
PRINTED = ROOT / "config" / "table1_printed.csv"
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text("utf-8"))


def module(name):
    """A script as a module: its functions, without its run."""
    specification = importlib.util.spec_from_file_location(name, SCRIPTS / f"{name}.py")
    found = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(found)
    return found


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Runs a script with the files and parameters of a rule."""

    def execute(name, inputs, outputs, params=None):
        # A script sends its errors to its log, and leaves that open until it ends.
        monkeypatch.setattr(sys, "stderr", sys.stderr)
        given = SimpleNamespace(
            input=Namedlist(fromdict=inputs),
            output=Namedlist(fromdict=outputs),
            params=Namedlist(fromdict=params or {}),
            log=[str(tmp_path / "log")],
        )
        path = str(SCRIPTS / f"{name}.py")
        before = sys.stderr
        try:
            runpy.run_path(path, {"snakemake": given}, "__main__")
        finally:
            if sys.stderr is not before:
                sys.stderr.close()

    return execute


# What they write


def shortened(given):
    """Parameters with few samples, so that a stage takes a second."""
    if isinstance(given, dict):
        return {key: 11 if key == "samples" else shortened(each) for key, each in given.items()}
    return given


@pytest.mark.parametrize(
    "stage",
    ["restitution_model", "apparent_restitution", "permanent_contact", "time_histories"],
)
def test_a_stage_writes_each_dataset_under_its_name_with_its_parameters(run, tmp_path, stage):
    config = shortened(CONFIG[stage])
    entries = {
        name: {"title": f"title of {name}", "parameters": given}
        for name, given in config.items()
        if name != "title"
    }
    files = {name: str(tmp_path / f"{name}.nc") for name in entries}
    code = [str(SCRIPTS / f"{stage}.py")]
    settings = {} if stage == "restitution_model" else {"release": "force"}
    run(stage, {"code": code}, files, {"entries": entries, "settings": settings})
    for name, file in files.items():
        data = read(file)
        assert parameters(data) == config[name] | settings
        assert data.attrs["title"] == f"title of {name}"


def test_an_entry_without_a_function_is_named(run):
    entries = {name: {"title": "", "parameters": {}} for name in ("fig11", "fig99")}
    with pytest.raises(ValueError, match="STAGE has no function for fig99"):
        run("permanent_contact", {"code": []}, {}, {"entries": entries, "settings": {}})


def test_tables_are_written_beside_their_datasets(run, tmp_path):
    names = ["thresholds", "table1"]
    made = {kind: [str(tmp_path / f"{name}.{kind}") for name in names] for kind in ("md", "csv")}
    run("tables", {"data": [str(REFERENCE / f"{name}.nc") for name in names]}, made)
    for name in names:
        rows = tables.TABLES[name](read(REFERENCE / f"{name}.nc"))
        assert (tmp_path / f"{name}.md").read_text("utf-8") == tables.markdown(rows)
        assert (tmp_path / f"{name}.csv").read_text("utf-8") == tables.comma_separated(rows)


def test_claims_are_judged_from_the_datasets_and_written_in_three_forms(run, tmp_path):
    code = [str(SCRIPTS / "claims.py")]
    files = sorted(path for path in REFERENCE.glob("*.nc") if path.stem != "claims")
    made = {kind: str(tmp_path / f"claims.{kind}") for kind in ("nc", "md", "csv")}
    inputs = {"data": [str(path) for path in files], "printed": str(PRINTED), "code": code}
    run("claims", inputs, made)
    expected = claims.judge({path.stem: read(path) for path in files}, printed_table(PRINTED))
    judged = read(made["nc"])
    xr.testing.assert_equal(judged, expected)
    assert Path(made["md"]).read_text("utf-8") == tables.claims_markdown(expected)
    every = tables.comma_separated(tables.all_claims(expected))
    assert Path(made["csv"]).read_text("utf-8") == every


@pytest.mark.parametrize(("factor", "status"), [(1.0, 0), (1.01, 1)])
def test_a_comparison_ends_with_1_if_something_differs(run, tmp_path, monkeypatch, factor, status):
    name = "lowest_doubling"  # It has no picture, which would be drawn.
    figures = tmp_path / "results" / "figures"
    figures.mkdir(parents=True)
    data = read(REFERENCE / f"{name}.nc")
    # As if it had been made by the script of today.
    code = json.dumps(contents([SCRIPTS / "continuation.py"]))
    changed = data.assign(period_doubling_turn=factor * data.period_doubling_turn)
    changed.assign_attrs(code=code).to_netcdf(figures / f"{name}.nc")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    given = {"results": "results", "reference": str(ROOT), "names": [name]}
    given["config"] = {"continuation": {name: parameters(data)}}
    with pytest.raises(SystemExit) as ended:
        run("compare", {}, {}, given)
    assert ended.value.code == status
    assert (tmp_path / "results" / "diff" / "index.html").is_file()


# What they compute


def test_the_ball_of_figure_2_obeys_the_law_of_the_impact():
    given = {"n": 2, "restitution": 0.65, "amplitude": 1.8, "periods": 2, "samples": 401}
    data = module("restitution_model").fig02(given)
    impact = 2 * np.pi * given["n"]
    table_speed = given["amplitude"] * np.cos(float(data.phase))
    # Eq. 2, with the velocity before the impact from a fall over the whole flight.
    before = float(data.ball_velocity[0]) - impact
    assert float(data.ball_velocity[0]) - table_speed == pytest.approx(
        -given["restitution"] * (before - table_speed), abs=1e-12
    )
    assert float(data.ball[0]) == pytest.approx(float(data.table[0]), abs=1e-12)
    # It is on the table at each impact, and above it in between.
    landings = np.isclose(data.time % impact, 0) | np.isclose(data.time % impact, impact)
    assert int(landings.sum()) == 1 + given["periods"]
    assert (data.ball > data.table)[~landings].all()


def test_the_branches_of_figure_3_are_orbits_up_to_the_largest_amplitude():
    given = {"n": [1, 2, 3], "restitution": 0.85, "amplitude_max": 2.0, "points": 41}
    data = module("restitution_model").fig03(given)
    # Eq. 6: X = Λ cos φ is nπ(1 - r)/(1 + r) on a whole branch, at equal steps of Λ sin φ.
    x = data.n * np.pi * 0.15 / 1.85
    xr.testing.assert_allclose((data.amplitude * np.cos(data.phase) / x), 0 * data.amplitude + 1)
    impact_height = data.amplitude * np.sin(data.phase)
    steps = impact_height.diff("point")
    assert float((steps.max("point") / steps.min("point") - 1).max()) < 1e-9
    ends = data.amplitude.isel(point=[0, -1])
    assert ends.values == pytest.approx(np.full((3, 2), 2.0))


READINGS = module("readings")


@pytest.fixture(scope="module")
def readings():
    """The printed numbers under other readings, computed from what is printed."""
    return READINGS.readings(printed_table(PRINTED))


def test_branches_have_the_special_points_of_each_contact_and_nothing_else():
    """A stiff and a compliant contact, whose branches have different numbers of them."""
    given = CONFIG["continuation"]["fig08"] | {"frequency_ratio": [10.0, 2.0], "points": 101}
    data = module("continuation").branches(given, "displacement", 0.2)
    zeta = float(damping_ratio(given["restitution"]))
    counts = []
    for ratio in given["frequency_ratio"]:
        contact = Contact(ratio, zeta, "displacement")
        found = branch(Family(given["n"], contact), given["amplitude_max"], given["points"])
        row = data.sel(frequency_ratio=ratio)
        count = len(found.special)
        counts.append(count)
        kinds = row.special_kind.values.tolist()
        assert kinds[:count] == [point.kind for point in found.special]
        assert set(kinds[count:]) <= {""}
        amplitudes = [point.orbit[0] for point in found.special]
        assert row.special_amplitude.values[:count] == pytest.approx(amplitudes)
        assert np.isnan(row.special_amplitude.values[count:]).all()
    assert counts[0] < counts[1] == data.sizes["special"]


def saddle_node(n, ratio, zeta, release):
    """The orbit at the saddle-node, from the closed form by the duration of the contact."""
    half = np.pi / ratio / np.sqrt(1 - zeta**2)

    def turn(duration):
        return independent.test_functions(n, ratio, zeta, release, duration)[0]

    durations = independent.roots(turn, half * np.linspace(0.7, 1.3, 601))
    orbits = [independent.orbit(n, ratio, zeta, release, duration) for duration in durations]
    (found,) = (y for y in orbits if abs(y[1]) < np.pi / 2 and y[2] < 0)
    return found


@pytest.mark.parametrize(
    ("reading", "release"),
    [("equations as they stand", "displacement"), ("force release", "force")],
)
def test_a_reading_has_the_saddle_nodes_of_its_release(readings, reading, release):
    zeta = independent.restitution_to_damping(0.85)
    found = readings.found.sel(reading=reading)
    for n in (1, 2):
        for ratio in (10.0, 2.0):
            expected = saddle_node(n, ratio, zeta, release)[0]
            end = found.sel(number=f"Table 1: {ratio:g}, {n}, saddle-node")
            assert float(end) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_cycle_of_figure_7_is_that_of_the_integrated_motion(release):
    given = {"n": 2, "restitution": 0.65, "amplitude": 1.8, "frequency_ratio": 20.0}
    data = module("time_histories").fig07(given | {"samples": 800}, release)
    zeta = independent.restitution_to_damping(0.65)
    state = float(data.phase), float(data.impact_velocity)
    moved = independent.cycle(20.0, zeta, release, 1.8, *state)
    assert moved.time == pytest.approx(4 * np.pi, abs=1e-9)
    assert data.time.values[-1] == pytest.approx(4 * np.pi)
    assert int(data.contact.sum()) == 400
    # The first half of the samples of both are in contact, at equal steps.
    assert data.time.values[:400] == pytest.approx(moved.times[:400], abs=1e-9)
    assert data.ball.values[:400] == pytest.approx(moved.heights[:400], abs=1e-9)
    assert data.ball_velocity.values[:400] == pytest.approx(moved.velocities[:400], abs=1e-8)
    flown = data.time.values[400:] - moved.contact.duration
    fall = moved.heights[400] + moved.bounce * flown - flown**2 / 2
    assert data.ball.values[400:] == pytest.approx(fall, abs=1e-8)
    assert data.ball[-1] == pytest.approx(float(data.ball[0]), abs=1e-8)


def test_the_contacts_of_figure_12_have_both_of_their_ends():
    given = CONFIG["time_histories"]["fig12"] | {"samples": 101}
    data = module("time_histories").fig12(given, "displacement")
    for one in (data.sel(frequency_ratio=ratio) for ratio in data.frequency_ratio):
        during = data.table_phase.values[one.contact.values]
        ends = float(one.phase), float(one.phase + one.contact_duration)
        assert (during[0], during[-1]) == pytest.approx(ends, abs=1e-12)


def test_the_numbers_of_a_reading_are_those_of_its_contact(readings):
    """The equations as they stand, and damping to first order by orbits of the closed form."""
    printed = {claim.name: claim.printed for claim in claims.CLAIMS if claim.printed}
    texts = readings.printed_text.to_series().to_dict()
    assert printed.items() <= texts.items()
    judged = read(REFERENCE / "claims.nc").set_index(claim="claim")
    plain = readings.sel(reading="equations as they stand")
    for name in readings.number.values:
        found = float(judged.found.sel(claim=name))
        assert float(plain.found.sel(number=name)) == pytest.approx(found, rel=1e-8)

    zeta = -np.log(0.65) / np.pi
    ratio = float(readings.found.sel(reading="damping to first order", number="height threshold"))
    half = np.pi / ratio / np.sqrt(1 - zeta**2)
    x = np.pi * 0.35 / 1.65
    highest = np.sqrt(1 - x**2) + np.pi**2 / 2

    def excess(duration):
        return independent.orbit(1, ratio, zeta, "displacement", duration)[0] - 1

    found = independent.roots(excess, half * np.linspace(0.97, 1.03, 601))
    orbits = [independent.orbit(1, ratio, zeta, "displacement", each) for each in found]
    (y,) = (each for each in orbits if 0 < each[1] < np.pi / 2 and each[2] < 0)
    moved = independent.cycle(ratio, zeta, "displacement", y[0], y[1], y[2])
    assert abs(moved.greatest_height() / highest - 1) == pytest.approx(0.01, abs=1e-9)


def test_readings_are_in_the_order_of_the_numbers_that_they_reproduce(readings):
    printed = readings.printed_text.values
    for line in (readings.isel(reading=k) for k in range(readings.sizes["reading"])):
        pairs = zip(line.found.values, printed, strict=True)
        verdicts = [against_print(found, text).verdict for found, text in pairs]
        assert int(line.reproduced) == verdicts.count("reproduced")
    assert (readings.reproduced.diff("reading") <= 0).all()


def test_the_damping_of_82_has_thresholds_that_round_to_it(readings):
    for zeta, ratio in zip(readings.damping_of_82.values, (81.5, 82.5), strict=True):
        impact = READINGS.Impact(lambda r, zeta=zeta: zeta)
        assert READINGS.other_numbers(impact)[0] == pytest.approx(ratio, rel=1e-9)


def test_a_row_that_a_contact_explains_is_found_and_any_other_fits_as_chance_has_it():
    slope = np.array([[14.0, 4600.0], [-2.0, 1300.0], [13.0, 9600.0], [1.0, 4500.0]])
    shift = np.array([0.1, -0.002])
    explained = -(slope @ shift)
    most = READINGS.most_reproduced(np.stack([explained, explained[[1, 0, 2, 3]] + 3]), slope)
    assert most[0] == 4
    assert most[1] < 4
    # A contact that is far away is not asked.
    far = READINGS.most_reproduced(10 * explained[np.newaxis], slope)
    assert far[0] < 4


def test_the_means_of_groups_are_chance_unless_they_differ():
    n = np.array([1, 2, 3])
    units = np.array([[[5.0, 5.1], [0.1, 0.2], [-5.0, -5.1]], [[5.2, 5.3], [0, 0.3], [-5.2, -5.3]]])
    apart = READINGS.chances(n, np.array([10.0, 2.0]), units)
    # Of the 34650 ways to deal twelve numbers to three groups of four, six have these groups.
    assert float(apart.mean_chance) == pytest.approx(6 / 34650)
    assert apart.mean_difference.values == pytest.approx([5.15, 0.15, -5.15])


# Where a frequency ratio is enough


MAP = CONFIG["validity"]["validity_map"]


def few(**changed):
    """Parameters of the validity map with few orbits."""
    small = {"restitution": {"min": 0.05, "max": 0.95, "samples": 7}, "places": 6}
    return MAP | small | changed


def test_the_curves_of_the_validity_map_are_those_of_the_figures_along_the_frequency_ratio():
    given = CONFIG["apparent_restitution"]
    cases = [(name, case) for name in ("fig05", "fig06") for case in given[name]["cases"]]
    expected = [{"n": given[name]["n"]} | case for name, case in cases]
    fig10 = given["fig10"]
    shared = {"n": fig10["n"], "restitution": fig10["restitution"]}
    expected += [shared | {"amplitude": amplitude} for amplitude in fig10["amplitude"]]
    assert [curve for curve in expected if curve not in MAP["curves"]] == []
    assert [curve for curve in MAP["curves"] if curve not in expected] == []


def test_the_shares_of_the_validity_map_are_those_of_its_errors():
    data = module("validity").validity_map(few(), "displacement")
    share = module("validity").positive_share
    # Positive from 0 to 0.25 and from 0.75 on.
    place = np.array([0.0, 0.5, 1.0])
    assert share(np.array([1.0, -1.0, 1.0]), place) == pytest.approx(0.5)
    assert share(np.array([0.0, 0.0, 1.0]), place) == pytest.approx(0.5)
    assert np.isnan(share(np.array([0.0, np.nan, 1.0]), place))
    fails = (data.stiff_error > 0.01).any("place")
    assert ((data.failing_share > 0) == fails).all()
    # At the advised ratio or above an error exceeds the tolerance if more than it is needed.
    clear = abs(data.stiff_error - 0.01) > 1e-6
    assert ((data.stiff_error > 0.01) == (data.enough_from > 100)).where(clear, True).all()
    assert (data.not_reached == 0).all()


def test_orbits_that_need_more_than_the_scan_are_counted_and_have_no_answer():
    given = few(frequency_ratio={"min": 10.0, "max": 1000.0, "samples": 21})
    data = module("validity").validity_map(given, "displacement")
    absent = data.enough_from.isnull().sum(["restitution", "place"])
    assert (data.not_reached == absent).all()
    # The height of the 1-T orbits beside their saddle-nodes, at small r.
    assert int(data.not_reached.sel(quantity="max_height", n=1)) > 0
    assert float(data.enough_from.sel(n=3).max()) < 1000


def test_the_doubled_orbits_are_those_beyond_the_period_doubling_of_the_contact():
    given = few(n=[2], restitution={"min": 0.2, "max": 0.8, "samples": 2})
    data = module("validity").validity_map(given, "displacement")
    for r in data.restitution.values:
        zeta = independent.restitution_to_damping(r)
        half = np.pi / 100 / np.sqrt(1 - zeta**2)

        def turn(duration, zeta=zeta):
            return independent.test_functions(2, 100.0, zeta, "displacement", duration)[1]

        durations = independent.roots(turn, half * np.linspace(0.97, 1.03, 601))
        orbits = [independent.orbit(2, 100.0, zeta, "displacement", each) for each in durations]
        (doubling,) = (y[0] for y in orbits if 0 < y[1] < np.pi / 2 and y[2] < 0)
        x = 2 * np.pi * (1 - r) / (1 + r)
        last = np.hypot(x, 2 * (1 + r**2) / (1 + r) ** 2)
        share = float(data.doubled_share.sel(n=2, restitution=r))
        assert share == pytest.approx((last - doubling) / (last - x), abs=1e-8)
