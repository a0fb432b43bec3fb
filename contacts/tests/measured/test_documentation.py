"""docs/measured.md: its files are read, its commands answer, and its list is complete."""

import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_contacts.measured.columns import COLUMNS, HIGHEST
from bouncing_ball_contacts.measured.experiment import (
    QUANTITIES,
    TEXTS,
    experiment,
    experiment_names,
    read,
)
from bouncing_ball_contacts.measured.flights import drag_length, heard
from bouncing_ball_contacts.measured.verdicts import Compatibility, error_size, judge, scatter

PAGE = (Path(__file__).parents[2] / "docs" / "measured.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```\w*\n(.*?)```", PAGE, re.DOTALL)


@pytest.fixture
def files(tmp_path, monkeypatch):
    """The files of the page, in the folder in which its commands are called."""
    monkeypatch.chdir(tmp_path)
    for name, block in zip(("drops.csv", "heard.csv", "several.csv"), BLOCKS, strict=False):
        (tmp_path / name).write_text(block, encoding="utf-8")
    return tmp_path


def test_the_files_of_the_page_are_read(files):
    drops = read(files / "drops.csv")
    assert drops.speeds.size == 5 and drops.drag_bias > 0
    assert read(files / "heard.csv", intervals=True).speeds.size == 3
    assert read(files / "several.csv", intervals=True).speeds.size == 4


def test_the_commands_of_the_page_answer(files, outcome):
    commands = [
        line for block in BLOCKS for line in block.splitlines() if "bouncing-ball fit" in line
    ]
    assert len(commands) == 4
    for line in commands:
        status, out, err = outcome(*shlex.split(line)[1:])
        assert (status, err) == (0, ""), line
        assert "as a contact" in out


def test_every_column_and_key_is_named():
    for name in (*COLUMNS, *(f"# {key}:" for key in (*QUANTITIES, *TEXTS))):
        assert f"`{name}`" in PAGE or f"`{name}" in PAGE, name


def test_every_experiment_is_in_the_list():
    rows = [
        line
        for line in PAGE.splitlines()
        if (line.startswith("| `") and " to " in line) or "`superball`" in line
    ]
    listed = " ".join(rows)
    for name in experiment_names():
        assert f"`{name}`" in listed
    # Two marbles share a row, and one experiment has a single speed.
    for name in set(experiment_names()) - {"blue_marble", "metal_marble", "superball"}:
        (row,) = (line for line in rows if f"`{name}`" in line)
        low, high = map(float, re.search(r"([\d.]+) to ([\d.]+) m/s", row).groups())
        speeds = experiment(name).speeds
        assert float(f"{speeds.min():.2g}") == low and float(f"{speeds.max():.2g}") == high
        assert f"| {speeds.size} |" in row


def test_membranes_and_drops_decide_as_the_page_says():
    constant, smooth, sharp = "restitution", "kuwabara-kono", "hunt-crossley"
    for name, compatible in (
        ("membrane_heavy", {constant, smooth}),
        ("membrane_light", {constant, smooth}),
        ("thin_drop", {sharp}),
        ("viscous_drop", set()),
    ):
        verdicts = judge(experiment(name).fit((constant, smooth, sharp)))
        for law, found in verdicts.items():
            wanted = Compatibility.COMPATIBLE if law in compatible else Compatibility.INCOMPATIBLE
            assert found.verdict is wanted, (name, law)


def test_the_errors_that_the_page_names_are_those_of_the_fits():
    croquet = experiment("croquet").fit()
    judged = judge(croquet)
    for number in (
        judged["restitution"].needed,
        judged["kuwabara-kono"].needed,
        error_size(croquet.points),
    ):
        assert f"{number:.4f}" in PAGE
    ball = experiment("bouncy_ball").fit().points
    height = np.sqrt(scatter(ball)[0])
    assert f"an error of {height * 1000:.0f} mm at all heights" in PAGE


def test_the_bounds_of_the_page_are_those_of_a_fall():
    mass = 7850 * np.pi / 6 * 0.05**3
    terminal = np.sqrt(STANDARD_GRAVITY * drag_length(mass, 0.05))
    assert f"a steel ball of 5 cm never falls faster than {terminal:.0f} m/s" in PAGE
    assert f"a flight of\nmore than {np.sqrt(8 * HIGHEST / STANDARD_GRAVITY):.0f} s" in PAGE


def test_the_drag_on_a_table_tennis_ball_is_some_per_cent():
    found = heard([0.8, 0.6, 0.45], length=drag_length(2.7e-3, 0.04))
    assert np.all((found.drag_bias < -0.01) & (found.drag_bias > -0.1))
