"""The commands and the scripts of docs/engines.md and README.md print what these pages say."""

import math
import re
import runpy
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball.cli.main import main
from bouncing_ball.contacts.engines.choice import ENGINES
from bouncing_ball.contacts.engines.engine import Physical

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "engines.md").read_text(encoding="utf-8")
BOUNCES = (ROOT / "docs" / "bounces.md").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS, SHOWN, OF_BOUNCES = (
    re.findall(r"```\n\$ ((?:.*\\\n)*.*)\n([^`]*)```", text) for text in (PAGE, README, BOUNCES)
)


@pytest.mark.slow
@pytest.mark.parametrize(("command", "printed"), BLOCKS + SHOWN + OF_BOUNCES)
def test_a_command_prints_what_the_page_says(command, printed, monkeypatch, capsys):
    program, *arguments = shlex.split(command.replace("\\\n", ""))
    monkeypatch.chdir(ROOT)
    if program == "bouncing-ball":
        main(arguments)
    else:
        monkeypatch.setattr(sys, "argv", arguments)
        runpy.run_path(arguments[0], run_name="__main__")
    out = capsys.readouterr().out
    # Where the page leaves something out, a part of it.
    part = "…" in printed
    assert printed.strip("…\n") in out if part else printed.rstrip() == out.rstrip()


def test_every_script_is_on_the_page_and_the_readme_asks_whether_a_coefficient_is_enough():
    scripts = sorted((ROOT / "docs" / "engines").glob("*.py"))
    commands = [command for command, _ in BLOCKS]
    assert {f"python docs/engines/{path.name}" for path in scripts} < set(commands)
    assert BLOCKS[0][0].startswith("bouncing-ball design --engine")
    ((command, answer),) = SHOWN
    assert command.startswith("bouncing-ball design") and "not good enough" in answer
    assert all(len(path.read_text(encoding="utf-8").splitlines()) <= 30 for path in scripts)


def test_the_table_has_every_engine_with_its_formulas_and_releases():
    rows = re.findall(r"^\| `([\w-]+)` \| (.+) \| (.+) \|$", PAGE, re.MULTILINE)
    assert [name for name, *_ in rows] == [*[*ENGINES][1:], "generic"]
    contact = Physical(2.0, 300.0, 5.0)
    for name, formulas, releases in rows:
        found = ENGINES[name].parameters(contact)
        values = {}
        for parameter, cell in re.findall(r"`(\w+)` = ([^`]+?)(?:, (?=`)|$)", formulas):
            python = re.sub(
                r"([\dk])(?=[kcm])", r"\1*", cell.replace("−", "-").replace("√", "sqrt")
            )
            values[parameter] = eval(python, dict(zip("mkc", contact, strict=True), sqrt=math.sqrt))
        assert set(values) >= set(ENGINES[name].names) - {"solimp"}
        for parameter, value in values.items():
            assert np.ravel(found[parameter]) == pytest.approx(np.ravel(value), rel=1e-15)
        assert re.findall("displacement|force|approach", releases) == list(
            map(str, ENGINES[name].releases)
        )
