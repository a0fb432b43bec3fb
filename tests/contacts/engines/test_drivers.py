"""The drivers and threads of docs/bounces.md in the engines: they print what the page says."""

import re
import runpy
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[3]
FOLDER = ROOT / "docs" / "bounces"
PAGE = (ROOT / "docs" / "bounces.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| `(\w+)_driver\.py` \| .+ \| ([\d.]+) \| ([\d.]+) \|$", PAGE, re.MULTILINE)
LAST_SEEN = {
    "pymunk": "7.3.1",
    "box2d": "2.3.10",
    "dartpy": "6.20.0",
    "pybullet": "3.2.7",
    "mujoco": "4.0.0",
    "newton": "1.8.0",
}
"""The version of each engine with which these tests were last seen to pass."""


def only_if_installed(name):
    if find_spec({"box2d": "Box2D"}.get(name, name)) is None:
        pytest.skip(f"{name} is not installed: make setup-engines")


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("name", "measured", "certified"), ROWS)
def test_a_driver_has_the_height_that_the_page_says(name, measured, certified):
    only_if_installed(name)
    found = runpy.run_path(str(FOLDER / "drivers" / f"{name}_driver.py"))
    heights = np.array(found["heights"])
    first = np.flatnonzero(np.diff(heights) > 0)[0]
    assert f"{heights[first:].max():.4f}" == measured


def test_the_page_has_every_driver_and_the_certified_heights():
    paths = sorted((FOLDER / "drivers").glob("*_driver.py"))
    assert {path.stem for path in paths} == {f"{name}_driver" for name, *_ in ROWS}
    assert {name for name, *_ in ROWS} == set(LAST_SEEN)
    heights = re.findall(r",(0\.\d{15}),", (FOLDER / "reference" / "bounces.csv").read_text())
    known = {f"{float(height):.4f}" for height in heights}
    assert {certified for _, _, certified in ROWS} <= known
    assert all(len(path.read_text().splitlines()) <= 16 for path in paths)


@pytest.mark.engines
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(
    ("thread", "engine", "printed"),
    [
        ("newton_1289", "newton", "asked 0.75, got 0.743"),
        ("rapier_974", "pymunk", "Chipmunk 0.09, 0.25, 0.64, 0.90"),
    ],
)
def test_a_thread_is_answered_by_its_engine(thread, engine, printed):
    only_if_installed(engine)
    answers = runpy.run_path(str(FOLDER / "threads.py"))["THREADS"]
    assert printed in answers[thread]()
