"""The command ``design`` of the installed program: its help and its examples."""

import functools
import json
import shlex
import subprocess
import sys

import pytest

from bouncing_ball_beyond.inherited.cli.options import meanings
from bouncing_ball_beyond.inherited.contacts.cli import design
from bouncing_ball_beyond.inherited.contacts.cli.commands import COMMANDS
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.engines.laws import LAWS

DESIGN = ["design", "--mass", "20 g", "--frequency", "50 Hz", "--acceleration", "0.8 g"]
DESIGN += ["--stiffness", "1e7 N/m", "--restitution", "0.85", "--n", "1"]


def test_the_program_lists_the_command(said):
    shown = said("--help")
    for name, about in COMMANDS.items():
        assert f"\n    {name} " in shown and about.purpose.split()[0] in shown


def test_the_help_says_what_the_docstrings_of_the_calls_say(said):
    shown = "".join(said("design", "--help").split()).replace("-", "")
    for name in ("stiffness", "restitution", "solref", "parameters", "from_engine"):
        assert "".join(meanings(Contact)[name].split()).replace("-", "") in shown
    # A line may break behind a hyphen of a name.
    assert f"Laws:{','.join(LAWS)}.".replace("-", "") in shown


def test_what_an_answer_does_not_need_is_not_imported():
    call = "design --mass 1 --frequency 1 --acceleration 5 --restitution 0.9 --n 1"
    pairs = [("--help", "numpy"), (call, "pint")]
    described = "design --mass 1 --stiffness 1e5 --restitution 0.75 --json"
    pairs += [(described, name) for name in ("scipy.optimize", "xarray", "pandas")]
    for arguments, unneeded in pairs:
        code = (
            "import sys\n"
            "from bouncing_ball_beyond.inherited.cli.main import main\n"
            "try:\n"
            f"    main({arguments!r}.split())\n"
            "except SystemExit:\n"
            "    pass\n"
            f"print('is imported:', {unneeded!r} in sys.modules)\n"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        assert done.stdout.splitlines()[-1] == "is imported: False"


@pytest.mark.parametrize(
    "example",
    [
        # A Hertz contact for each family takes seconds.
        pytest.param(
            each,
            id=each.split(" --mass")[0],
            marks=pytest.mark.long if "--radius" in each else (),
        )
        for about in COMMANDS.values()
        for each in about.examples
    ],
)
def test_the_examples_of_the_help_run(example, said, short_runs):
    command, *given = shlex.split(example)
    assert said(command, *given)
    assert f"bouncing-ball {example}" in said(command, "--help")


def test_every_command_is_explained(said):
    for command in COMMANDS:
        assert "examples:" in said(command, "--help")


def test_a_page_is_refused_before_its_contents_are_computed(refused, monkeypatch):
    @functools.wraps(design.answer_design)
    def computed(*given, **more):
        pytest.fail("computed before the file was refused")

    monkeypatch.setattr(design, "answer_design", computed)
    status, line = refused("design", "--plot", "/dev/null/a.svg")
    assert status == 2 and "/dev/null/a.svg cannot be written: /dev/null is no folder" in line


# Packages of the extras, which an engineer's installation does not have.
ABSENT = ("matplotlib", "netCDF4", "PIL", "pydantic", "yaml", "snakemake", "pypandoc")


def without_extras(code):
    """A program for which the packages of the extras are not installed."""
    absent = f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}))"
    command = [sys.executable, "-c", f"{absent}\n{code}"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_without_the_extras_calls_and_commands_work_or_say_in_one_line_what_they_need():
    done = without_extras(
        "from bouncing_ball_beyond.inherited import contacts\n"
        "from bouncing_ball_beyond.inherited.cli.main import main\n"
        "names = [name for name in contacts.__all__ if getattr(contacts, name)]\n"
        f"main([*{DESIGN!r}, '--json'])\n"
        "print(names == contacts.__all__)\n"
        f"main([*{DESIGN!r}, '--plot', 'page.png'])\n"
    )
    assert done.returncode == 2
    designed, named = done.stdout.splitlines()
    assert json.loads(designed) and named == "True"
    # A busy machine says beside it that there is no answer yet.
    (said,) = [line for line in done.stderr.splitlines() if "no answer after" not in line]
    assert said.startswith("bouncing-ball: matplotlib is not installed: ")
    assert "the extra 'plot'" in said
