"""The worked examples print what the page says."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
SHOWN = dict(re.findall(r"```\n\$ python (docs/design/\w+\.py)\n(.*?)```", PAGE, re.DOTALL))


def test_every_script_is_on_the_page():
    scripts = (ROOT / "docs" / "design").glob("*.py")
    assert set(SHOWN) == {f"docs/design/{path.name}" for path in scripts}


@pytest.mark.slow
@pytest.mark.parametrize(
    # A Hertz contact for each family takes seconds.
    "script",
    [pytest.param(x, marks=[pytest.mark.long] * ("steel" in x)) for x in SHOWN],
)
def test_a_worked_example(script, capsys):
    runpy.run_path(str(ROOT / script))
    assert capsys.readouterr().out == SHOWN[script]
