"""The lesson draws the pictures that it shows."""

import doctest
import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

DOCS = Path(__file__).parents[2] / "docs" / "inherited"
PAGE = DOCS / "lesson.md"


@pytest.mark.slow
def test_the_lesson_prints_and_draws_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    plt.switch_backend("agg")
    try:
        result = doctest.testfile(str(PAGE), module_relative=False, optionflags=doctest.ELLIPSIS)
    finally:
        plt.close("all")
    assert result.failed == 0 and result.attempted > 15
    shown = re.findall(r"!\[.+\]\(lesson/(.+)\)", PAGE.read_text(encoding="utf-8"))
    drawn = sorted(path.name for path in tmp_path.iterdir())
    assert drawn == sorted(shown) == sorted(path.name for path in (DOCS / "lesson").iterdir())
