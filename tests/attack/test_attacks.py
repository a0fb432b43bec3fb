"""Each attack for half a second, and what the runner makes of those that fall."""

import runpy
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
RUNNER = runpy.run_path(str(HERE / "__main__.py"))

pytestmark = pytest.mark.slow


def run(*arguments, folder=HERE):
    return subprocess.run(
        [sys.executable, str(folder), *arguments], capture_output=True, text=True, check=False
    )


def short_or_long(name):
    """An attack on runs of the pipeline takes its time for one case."""
    return pytest.param(name, marks=pytest.mark.long if name == "interruptions" else ())


@pytest.mark.parametrize("name", [short_or_long(name) for name in RUNNER["attacks"]()])
def test_nothing_falls_in_half_a_second(name, monkeypatch):
    # In this process: another would take longer to start than it attacks.
    monkeypatch.syspath_prepend(HERE)
    tried, fallen = RUNNER["run_here"](name, 1, 0.5)
    assert tried > 0 and not fallen


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("yield ['', '', 'seed 7: case 2']", "seed 7: case 2"),
        ("yield from ()", "seed 7: nothing was tried in 1 s"),
        ("raise ValueError('no')", "seed 7: ended with 1: ValueError: no"),
    ],
)
def test_what_falls_is_said_and_ends_in_failure(tmp_path, body, said):
    folder = tmp_path / "tests" / "attack"
    folder.mkdir(parents=True)
    (folder / "__main__.py").write_bytes((HERE / "__main__.py").read_bytes())
    (folder / "walls.py").write_text(
        f'"""Walls, knocked at."""\n\n\ndef attack(seed):\n    {body}\n', encoding="utf-8"
    )
    table = tmp_path / "attacks.md"
    done = run("--seed", "7", "--seconds", "1", "--table", str(table), folder=folder)
    assert done.returncode == 1 and said in done.stdout
    text = table.read_text(encoding="utf-8")
    assert said in text and "| walls | Walls, knocked at |" in text
