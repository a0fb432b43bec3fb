"""The lesson and the page of the datasets print what they show; notebooks are made from them."""

import doctest
import json
import re
import runpy
from importlib.resources import files
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

DOCS = Path(__file__).parents[1] / "docs"
PAGE = DOCS / "lesson.md"


@pytest.mark.long
def test_the_lesson_prints_and_draws_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = doctest.testfile(str(PAGE), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert result.failed == 0 and result.attempted > 15
    shown = re.findall(r"!\[.+\]\(lesson/(.+)\)", PAGE.read_text(encoding="utf-8"))
    drawn = sorted(path.name for path in tmp_path.iterdir())
    assert drawn == sorted(shown) == sorted(path.name for path in (DOCS / "lesson").iterdir())


def test_the_lesson_shows_every_scene_of_the_stage():
    scenes = json.loads(files("bouncing_ball.explorer").joinpath("scenes.json").read_text())
    shown = re.findall(
        r"\(\.\./figures/beyond/explorer\.html#scene=(\w+)\)", PAGE.read_text("utf-8")
    )
    assert sorted(shown) == sorted(scenes)


def test_the_page_of_the_datasets_prints_what_it_says(monkeypatch):
    monkeypatch.chdir(DOCS)
    monkeypatch.setenv("MPLBACKEND", "agg")
    result = doctest.testfile(str(DOCS / "datasets.md"), module_relative=False)
    plt.close("all")
    assert result.failed == 0 and result.attempted > 15


@pytest.mark.parametrize("name", ["lesson", "datasets"])
def test_a_notebook_is_made_from_its_page_and_its_code_runs(name, monkeypatch):
    made = runpy.run_path(str(DOCS / "notebook.py"))["notebook"]
    page, notebook = (DOCS / f"{name}.{kind}" for kind in ("md", "ipynb"))
    text = notebook.read_text(encoding="utf-8")
    assert made(page.read_text(encoding="utf-8")) == text
    if name == "lesson":
        return  # Its code takes a minute; the test of its page runs the same code.
    monkeypatch.chdir(DOCS)
    cells = [cell["source"] for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    assert cells[0] == "%matplotlib inline" and len(cells) > 8
    names: dict = {}
    for cell in cells[1:]:
        exec(cell, names)
    plt.close("all")
    assert "difference" in names
