"""The commands and the scripts of docs/engines.md, docs/bounces.md and README.md print what these
pages say."""

import io
import math
import re
import runpy
import shlex
import sys

import numpy as np
import pandas
import pytest
from scipy.integrate import solve_ivp
from the_docs import DOCS

from bouncing_ball_beyond.inherited.cli.main import main
from bouncing_ball_contacts.documents.bounces_figures import in_javascript, rapier_974
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.engine import Physical

PAGE = (DOCS / "engines.md").read_text(encoding="utf-8")
BOUNCES = (DOCS / "bounces.md").read_text(encoding="utf-8")
README = (DOCS.parent / "README.md").read_text(encoding="utf-8")
BLOCKS, SHOWN, OF_BOUNCES = (
    re.findall(r"```\n\$ ((?:.*\\\n)*.*)\n([^`]*)```", text) for text in (PAGE, README, BOUNCES)
)


@pytest.mark.slow
@pytest.mark.parametrize(("command", "printed"), BLOCKS + SHOWN + OF_BOUNCES)
def test_a_command_prints_what_the_page_says(command, printed, monkeypatch, capsys):
    program, *arguments = shlex.split(command.replace("\\\n", ""))
    monkeypatch.chdir(DOCS.parent)
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
    scripts = sorted((DOCS / "engines").glob("*.py"))
    commands = [command for command, _ in BLOCKS]
    assert {f"python docs/engines/{path.name}" for path in scripts} < set(commands)
    assert BLOCKS[0][0].startswith("bouncing-ball design --engine")
    command, answer = SHOWN[0]
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


def test_the_table_of_rapier_974_is_that_of_its_file():
    folder = DOCS / "bounces"
    lines = (folder / "rapier_974.csv").read_text(encoding="utf-8").splitlines()
    table = rapier_974(lines)
    assert f"<!-- rapier_974 -->\n\n{table}" in BOUNCES
    assert table.splitlines()[2].startswith("| r² |  |  | 0.0900 | 0.2500 |")
    assert len(table.splitlines()) == len(lines) + 2


def test_the_engines_for_javascript_bounce_as_the_page_says():
    lines = (DOCS / "bounces" / "javascript.csv").read_text(encoding="utf-8").splitlines()
    assert f"<!-- javascript -->\n\n{in_javascript(lines)}" in BOUNCES
    found = pandas.read_csv(io.StringIO("\n".join(lines)))
    jolt = found[found.engine == "Jolt"]
    elastic = jolt[jolt.r == 1]
    assert (abs(elastic["mean"] - 1) < 0.001).all()
    slow = jolt[(jolt["drop in m"] == 0.1) & (jolt.r < 0.75) & (jolt["time step in s"] != "1/1000")]
    assert (slow["mean"] > slow.r + 0.02).all()
    default = found[found.engine == "PhysX 5.6.1"]
    assert (default[default["drop in m"] == 0.1]["mean"] < 0.05).all()
    other = found[found.engine.str.endswith("= 0.01")]
    gained = other[(other.r == 1) & (other["time step in s"] == "1/60")]
    # The speed that gravity adds in a step of 1/60 s, over that of the impact.
    steps = 9.81 / 60 / np.sqrt(2 * 9.81 * gained["drop in m"])
    assert (abs(gained["mean"] - 1 - steps) < 0.02).all()
    box = found[found.engine == "Box2D 3"]
    assert (box["mean"] < box.r).all()


@pytest.mark.parametrize("asked", [0.9, 0.75, 0.5])
def test_the_answer_on_openhfdib_is_that_of_its_force(asked):
    """A sphere of unit radius on a wall, with the force of the source, by scipy."""
    mass, stiffness, speed = 1.0, 1e6, 0.1
    reduced = mass / 2
    length = 1.0 / 2
    beta = -math.sqrt(5) * math.log(asked) / math.hypot(math.log(asked), math.pi)

    def force(depth, rate):
        volume = math.pi * depth**2 * (3 - depth) / 3
        area = math.pi * (2 * depth - depth**2)
        elastic = stiffness * volume / length
        damping = beta * math.sqrt(stiffness * reduced * area / length) * rate
        return elastic + max(damping, -elastic)

    def out(t, y):
        return y[0] if t > 0 else 1.0

    out.terminal, out.direction = True, -1
    path = solve_ivp(
        lambda t, y: (y[1], -force(max(y[0], 0.0), y[1]) / mass),
        (0, 1.0),
        (0.0, speed),
        events=out,
        rtol=1e-9,
        atol=1e-14,
        max_step=1e-3,
    )
    answer = runpy.run_path(str(DOCS / "bounces" / "threads.py"))["openhfdib_18"]()
    promised = dict(
        zip((0.9, 0.75, 0.5), map(float, answer.split("r = ")[1].split(", ")), strict=True)
    )
    # The ball sinks in by some thousandths of its radius, and the answer has three digits.
    assert -path.y[1, -1] / speed == pytest.approx(promised[asked], abs=2e-3)
