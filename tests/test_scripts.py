"""The scripts of the workflow: what they compute, and that they write what a rule gives them.

Each is run as Snakemake runs it, with the lists of files and parameters of its rule. That the
numbers of a whole run are those of the reference is for `make replication` to say.
"""

import importlib.util
import json
import runpy
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
import yaml
from scipy.optimize import least_squares
from snakemake.iocontainers import Namedlist
from tests import independent

from bouncing_ball import claims, tables
from bouncing_ball.continuation import branch
from bouncing_ball.datasets import parameters, printed_table, read
from bouncing_ball.history import contents
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact, damping_ratio

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
    figures = tmp_path / "results" / "figures"
    figures.mkdir(parents=True)
    for path in REFERENCE.glob("fig11.*"):
        shutil.copyfile(path, figures / path.name)
    data = read(REFERENCE / "fig11.nc")
    # As if it had been made by the script of today.
    code = json.dumps(contents([SCRIPTS / "permanent_contact.py"]))
    changed = data.assign(threshold_amplitude=factor * data.threshold_amplitude)
    changed.assign_attrs(code=code).to_netcdf(figures / "fig11.nc")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    given = {"results": "results", "reference": str(ROOT), "names": ["fig11"]}
    given["config"] = {"permanent_contact": {"fig11": parameters(data)}}
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
    # Eq. 6: X = Λ cos φ is nπ(1 - r)/(1 + r) on a whole branch, and lifts are at equal steps.
    x = data.n * np.pi * 0.15 / 1.85
    xr.testing.assert_allclose((data.amplitude * np.cos(data.phase) / x), 0 * data.amplitude + 1)
    lift = data.amplitude * np.sin(data.phase)
    steps = lift.diff("point")
    assert float((steps.max("point") / steps.min("point") - 1).max()) < 1e-9
    ends = data.amplitude.isel(point=[0, -1])
    assert ends.values == pytest.approx(np.full((3, 2), 2.0))


READINGS = module("table1_readings")


@pytest.fixture(scope="module")
def readings():
    """Table 1 under other readings, computed from what is printed."""
    return READINGS.table1_readings(printed_table(PRINTED).astype(float))


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
    found = readings.computed.sel(reading=reading, bound="saddle-node")
    for n in (1, 2):
        for ratio in (10.0, 2.0):
            expected = saddle_node(n, ratio, zeta, release)[0]
            assert float(found.sel(n=n, frequency_ratio=ratio)) == pytest.approx(expected, abs=1e-9)


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


def test_a_tolerance_is_needed_where_the_printed_amplitude_is_below_every_orbit(readings):
    """Orbits exist from the saddle-node on."""
    nodes = readings.sel(reading="equations as they stand", bound="saddle-node")
    below = nodes.printed < nodes.computed
    assert ((readings.needed_tolerance > 0) == below).all()
    assert below.any() and not below.all()


def unknowns_at(n, ratio, zeta, y):
    """The unknowns of Eqs. 21 to 26 at an orbit, of which A and B are solutions of Eqs. 21, 22."""
    amplitude, phase, impact, angle = y
    flight = 2 * np.pi * n - angle / ratio
    unknowns = np.array([phase, impact, impact + flight, angle, 0.0, 0.0, amplitude])

    # Both are linear in A and B.
    def defects(a, b):
        moved = unknowns + np.array([0, 0, 0, 0, a, b, 0])
        return READINGS.paper_equations(n, ratio, zeta, moved)[:2]

    none = defects(0.0, 0.0)
    columns = np.stack([defects(1.0, 0.0) - none, defects(0.0, 1.0) - none], axis=-1)
    unknowns[4:6] = np.linalg.solve(columns, -none)
    return unknowns


@pytest.mark.parametrize(("n", "ratio", "r"), [(1, 2.0, 0.85), (2, 10.0, 0.85), (3, 30.0, 0.2)])
def test_orbits_of_the_integrated_motion_solve_equations_21_to_26(n, ratio, r):
    zeta = independent.restitution_to_damping(r)
    half = np.pi / ratio / np.sqrt(1 - zeta**2)
    y = independent.orbit(n, ratio, zeta, "displacement", 0.99 * half)
    unknowns = unknowns_at(n, ratio, zeta, y)
    defects = READINGS.paper_equations(n, ratio, zeta, unknowns)
    # Rounding of numbers of the size of a flight.
    assert defects == pytest.approx(np.zeros(6), abs=1e-11 * n)


@pytest.mark.parametrize(("n", "ratio"), [(1, 2.0), (1, 10.0), (2, 10.0)])
def test_the_needed_tolerance_is_the_least_norm_of_the_defects(n, ratio):
    zeta = independent.restitution_to_damping(0.85)
    node = saddle_node(n, ratio, zeta, "displacement")
    start = unknowns_at(n, ratio, zeta, node)
    for below in (1e-3, 1e-4):
        amplitude = node[0] - below

        def defects(unknowns, amplitude=amplitude):
            return READINGS.paper_equations(n, ratio, zeta, np.append(unknowns, amplitude))

        least = least_squares(defects, start[:6], xtol=1e-15, ftol=1e-15, gtol=1e-15)
        norm = np.linalg.norm(least.fun)
        needed = READINGS.needed_tolerance(n, ratio, zeta, node, amplitude)
        # What it neglects is smaller by the distance from the saddle-node.
        assert needed == pytest.approx(norm, rel=below)
    assert READINGS.needed_tolerance(n, ratio, zeta, node, node[0] + 1e-3) == 0


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
