"""The commands and the scripts of docs/engines.md print what the page says."""

import re
import runpy
import shlex
from pathlib import Path

import pytest

from bouncing_ball.cli.main import main
from bouncing_ball.engines import ENGINES

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "engines.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```\n\$ (.*)\n([^`]*)```", PAGE)


@pytest.mark.slow
@pytest.mark.parametrize(("command", "printed"), BLOCKS)
def test_a_command_prints_what_the_page_says(command, printed, monkeypatch, capsys):
    program, *arguments = shlex.split(command)
    monkeypatch.chdir(ROOT)
    if program == "bouncing-ball":
        main(arguments)
    else:
        runpy.run_path(*arguments, run_name="__main__")
    out = capsys.readouterr().out
    # Of the other engines the page shows the part to paste.
    part = printed.startswith("…")
    assert printed.strip("…\n") in out if part else printed.rstrip() == out.rstrip()


def test_every_script_and_every_engine_is_on_the_page():
    scripts = sorted((ROOT / "docs" / "engines").glob("*.py"))
    commands = [command for command, _ in BLOCKS]
    assert {f"python docs/engines/{path.name}" for path in scripts} < set(commands)
    assert all(len(path.read_text(encoding="utf-8").splitlines()) <= 30 for path in scripts)
    recipes = re.findall(r"^bouncing-ball design --engine (\w+)", "\n".join(commands), re.MULTILINE)
    assert {*recipes, "generic"} == set(ENGINES) and len(BLOCKS) == len(recipes) + 6


def test_the_readme_shows_a_part_of_the_first_recipe():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    shown = dict(re.findall(r"```\n\$ (.*)\n…\n([^`]*)…\n```", readme))
    assert len(shown) == 1 and all(text in dict(BLOCKS)[command] for command, text in shown.items())


def test_the_links_of_the_page_lead_somewhere():
    links = re.findall(r"\]\(([^)#]+)\)", PAGE)
    assert len(links) >= 4 and all((ROOT / "docs" / link).exists() for link in links)
