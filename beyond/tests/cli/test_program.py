"""Beyond's commands in the installed program: their help, and the examples in it."""

import functools
import importlib
import inspect
import shlex

import pytest

from bouncing_ball_beyond.cli.commands import COMMANDS
from bouncing_ball_beyond.inherited.cli.answers import COMMANDS as ALL
from bouncing_ball_beyond.inherited.cli.options import meanings
from bouncing_ball_beyond.models.makers import spring_damper
from bouncing_ball_beyond.models.named_laws import LAWS


def test_the_commands_are_among_all():
    assert COMMANDS.items() <= ALL.items()


def test_the_help_says_what_the_docstrings_of_the_calls_say(said):
    shown = "".join(said("law-orbit", "--help").split()).replace("-", "")
    texts = meanings(spring_damper)
    for name in inspect.signature(spring_damper).parameters:
        assert "".join(texts[name].split()).replace("-", "") in shown
    # A line may break behind a hyphen of a name.
    asked = "".join(said("law-orbit", "--help").split()).replace("-", "")
    assert f"Laws:{','.join(LAWS)}.".replace("-", "") in asked
    assert "(default: -3.142)" in said("law-simulate", "--help")


@pytest.mark.parametrize(
    "example", [each for about in COMMANDS.values() for each in about.examples]
)
def test_the_examples_of_the_help_run(example, said):
    command, *given = shlex.split(example)
    assert said(command, *given)
    assert f"bouncing-ball {example}" in said(command, "--help")


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_is_explained_and_its_symbols_are(said, name):
    shown = said(name, "--help")
    assert "examples:" in shown
    assert "Eq. 16" not in shown or "exp(-πζ/√(1 - ζ²))" in " ".join(shown.split())
    # An example of a command is one of this command.
    assert all(example.split()[0] == name for example in COMMANDS[name].examples)


def test_a_file_is_refused_before_its_contents_are_computed(refused, monkeypatch):
    module, name = "bouncing_ball_beyond.motions.motion_of", "orbit_diagram"
    computation = getattr(importlib.import_module(module), name)

    # The options of the command are made from the signature.
    @functools.wraps(computation)
    def computed(*given, **more):
        pytest.fail("computed before the file was refused")

    monkeypatch.setattr(f"{module}.{name}", computed)
    call = "diagram --restitution 0.5 --amplitude 1 2 --plot /dev/null/a.svg"
    status, line = refused(*call.split())
    assert status == 2 and "/dev/null/a.svg cannot be written: /dev/null is no folder" in line


def test_a_phase_beyond_a_turn_is_noted(ask):
    ball = ("--restitution", "0.5", "--amplitude", "0.5")
    note = "phase 400 is in radians, 63.66 turns of the table; 400 degrees are 6.981"
    for command in ("motion", "law-simulate"):
        assert ask(command, *ball, "--phase", "400", "--impacts", "10")["note"] == note
        assert "note" not in ask(command, *ball, "--phase", "6.28", "--impacts", "10")
