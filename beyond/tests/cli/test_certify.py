"""``certify``: proved digits, and one line for what cannot be proved."""

import importlib
import re
import shlex
import sys
from decimal import Decimal
from pathlib import Path

import pytest

import bouncing_ball_beyond
from bouncing_ball.errors import ModelError

PAGE = (Path(__file__).parents[2] / "docs" / "proofs.md").read_text(encoding="utf-8")
GIVEN = ("certify", "--restitution", "0.85", "--frequency-ratio", "10")


def test_the_certified_digits_contain_those_of_double_precision(ask):
    answer = ask(*GIVEN)
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    for name, limit in bouncing_ball_beyond.limits(ball)._asdict().items():
        proof = answer[name]
        assert abs(float(proof["amplitude"]) - limit.amplitude) < 1e-14
        assert len(proof["amplitude"].lstrip("0.").replace(".", "")) == 30
        assert float(proof["radius"]) < 1e-29
        assert {"exactly one solution", "admissible"} <= {*proof["proved"]}


def test_fewer_digits_are_the_rounded_ones(ask):
    many, few = (ask(*GIVEN, "--digits", digits) for digits in ("40", "12"))
    for name in many:
        exact, rounded = (Decimal(one[name]["amplitude"]) for one in (many, few))
        assert abs(exact - rounded) <= Decimal(few[name]["radius"])


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (GIVEN[:3], "required: --frequency-ratio"),
        ((*GIVEN, "--digits", "3"), "from 10 to 100"),
        ((*GIVEN, "--model", "corrected"), "--model corrected: it is an option of"),
        ((*GIVEN, "--release", "force"), "--release force: it is an option of"),
        (("certify", "--frequency-ratio", "10"), "required: --restitution"),
        (
            ("certify", "--restitution", "1", "--frequency-ratio", "10"),
            "without dissipation",
        ),
    ],
)
def test_what_cannot_be_certified_is_refused_in_one_line(refused, options, says):
    _, line = refused(*options)
    assert says in line


def test_a_missing_bifurcation_has_the_same_exit_status_as_without_a_proof(refused):
    options = ("--restitution", "1e-9", "--frequency-ratio", "10")
    for command in ("law-limits", "certify"):
        status, line = refused(command, *options)
        assert status == 1 and "no saddle-node" in line


def test_the_command_prints_what_the_page_shows(said):
    [(command, shown)] = re.findall(r"```\n\$ bouncing-ball (.*)\n([^`]*)```", PAGE)
    assert said(*shlex.split(command)) == shown


def test_without_the_library_of_balls_it_says_what_to_install(refused, monkeypatch):
    # A module that is None cannot be imported; those that need it are imported again.
    proofs = "bouncing_ball_beyond.proofs"
    for name in [name for name in sys.modules if f"{name}.".startswith(f"{proofs}.")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "flint", None)
    status, line = refused(*GIVEN)
    assert status == 2 and line.endswith('pip install . "./beyond[proofs]"')
    for module in (proofs, f"{proofs}.balls", f"{proofs}.certificates"):
        with pytest.raises(ModelError, match="flint is not installed: install the extra 'proofs'"):
            importlib.import_module(module)
