"""The drivers and threads of docs/bounces.md: the page has what they print.

`make test-engines` writes the dataset docs/data/bounce_drivers.nc.
"""

import csv
import runpy

import pytest
import xarray as xr
from driver_runs import DRIVERS, certified, top
from installed_engines import LAST_SEEN, only_if_installed
from the_docs import DATA, DOCS, MEASURED

from bouncing_ball_beyond.inherited.datasets.files import read_dataset, write_dataset
from bouncing_ball_beyond.inherited.datasets.variables import describe
from bouncing_ball_contacts.documents.bounces import ALL_VARIABLES, DRIVERS_TITLE

FOLDER = DOCS / "bounces"


@pytest.fixture(scope="module")
def record():
    heights = {}
    yield heights
    if set(heights) != set(DRIVERS):
        return
    data = xr.Dataset(
        {
            "driver_rule": ("driver", [each.rule for each in DRIVERS.values()]),
            "driver_step": ("driver", [each.time_step for each in DRIVERS.values()]),
            "driver_height": ("driver", [heights[name] for name in DRIVERS]),
            "driver_certified": ("driver", [certified(name) for name in DRIVERS]),
        },
        coords={"driver": list(DRIVERS)},
    )
    data = describe(data, ALL_VARIABLES).assign_attrs(title=DRIVERS_TITLE, history=MEASURED)
    write_dataset(data, DATA / "bounce_drivers.nc")


@pytest.mark.engines
@pytest.mark.parametrize("name", DRIVERS)
def test_a_driver_has_the_height_that_the_page_says(name, record):
    only_if_installed(name)
    record[name] = top(name)
    data = read_dataset(DATA / "bounce_drivers.nc")
    # The page has four digits.
    said = float(data.driver_height.sel(driver=name))
    assert record[name] == pytest.approx(said, abs=1e-4)


def test_every_driver_is_in_the_dataset_with_its_certified_height():
    paths = sorted((FOLDER / "drivers").glob("*_driver.py"))
    assert {path.stem for path in paths} == {f"{name}_driver" for name in DRIVERS}
    data = read_dataset(DATA / "bounce_drivers.nc")
    assert data.driver.values.tolist() == list(DRIVERS)
    known = [certified(name) for name in DRIVERS]
    assert data.driver_certified.values.tolist() == known
    assert all(len(path.read_text().splitlines()) <= 18 for path in paths)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(
    ("thread", "engine", "printed"),
    [
        ("newton_1289", "newton", "asked 0.75, got 0.743"),
        ("rapier_974", "pymunk", "Chipmunk 0.09, 0.25, 0.64, 0.90"),
        ("rapier_974", "rapier", "Rapier 0.09, 0.24, 0.62, 0.88"),
        ("rapier_919", "rapier", "0.02: 0.790, 0.1: 0.790"),
        (
            "drake_24063",
            "drake",
            "cenic 0.001: 0.502, cenic 1e-05: 0.546, runge_kutta3 0.001: 0.57",
        ),
    ],
)
def test_a_thread_is_answered_by_its_engine(thread, engine, printed):
    only_if_installed(engine)
    answers = runpy.run_path(str(FOLDER / "threads.py"))["THREADS"]
    assert printed in answers[thread]()


@pytest.mark.engines
def test_rapier_in_python_has_the_rows_of_the_table_of_its_thread():
    only_if_installed("rapier")
    drop = runpy.run_path(str(FOLDER / "threads.py"))["_rapier"]
    with (FOLDER / "rapier_974.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    here = [row for row in rows if row["version"] == f"Python {LAST_SEEN['rapier']}"]
    assert len(here) == 3
    for row in here:
        step = 1 / float(row["time step in s"].removeprefix("1/"))
        prediction = float(row["distance of prediction"])
        for asked in ("0.30", "0.50", "0.80", "0.95"):
            got = drop(float(asked), 2.0, step, prediction) ** 2
            # The file has four digits.
            assert got == pytest.approx(float(row[asked]), abs=1e-4)
