"""The worked examples print what the page says."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
SHOWN = dict(re.findall(r"```\n\$ python (docs/design/\w+\.py)\n(.*?)```", PAGE, re.DOTALL))


def test_every_script_is_on_the_page():
    scripts = (ROOT / "docs" / "design").glob("*.py")
    assert set(SHOWN) == {f"docs/design/{path.name}" for path in scripts}


def marked(script):
    """The script, for weekly if it designs a Hertz contact for each family, which takes seconds."""
    return pytest.param(script, marks=pytest.mark.long) if "steel" in script else script


@pytest.mark.slow
@pytest.mark.parametrize("script", [marked(script) for script in SHOWN])
def test_a_worked_example_prints_what_the_page_shows(script, capsys):
    runpy.run_path(str(ROOT / script))
    assert capsys.readouterr().out == SHOWN[script]
