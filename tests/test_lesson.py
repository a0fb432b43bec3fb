"""The lesson and the page of the datasets print what they show."""

import doctest
import json
import re
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
    scenes = json.loads(files("bouncing_ball_beyond.explorer").joinpath("scenes.json").read_text())
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
