"""``limits --certify``: proved digits, and one line for what cannot be proved."""

import re
import shlex
from decimal import Decimal
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "proofs.md").read_text(encoding="utf-8")
GIVEN = ("limits", "--restitution", "0.85", "--frequency-ratio", "10")


def test_the_certified_digits_contain_those_of_double_precision(ask):
    answer = ask(*GIVEN, "--certify")
    for name in ("saddle_node", "period_doubling"):
        proof = answer["certified"][name]
        assert abs(float(proof["amplitude"]) - answer[name]["amplitude"]) < 1e-14
        assert len(proof["amplitude"].lstrip("0.").replace(".", "")) == 30
        assert float(proof["radius"]) < 1e-29
        assert {"exactly one solution", "admissible"} <= {*proof["proved"]}


def test_fewer_digits_are_the_rounded_ones(ask):
    many, few = (ask(*GIVEN, "--certify", digits)["certified"] for digits in ("40", "12"))
    for name in many:
        exact, rounded = (Decimal(one[name]["amplitude"]) for one in (many, few))
        assert abs(exact - rounded) <= Decimal(few[name]["radius"])


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (("limits", "--restitution", "0.85", "--certify"), "needs --frequency-ratio"),
        ((*GIVEN, "--certify", "3"), "from 10 to 100"),
        ((*GIVEN, "--model", "corrected", "--certify"), "not allowed with --model"),
        ((*GIVEN, "--release", "force", "--certify"), "not allowed with --release"),
        (
            ("limits", "--measured-restitution", "0.8", "--frequency-ratio", "10", "--certify"),
            "not allowed with --measured-restitution",
        ),
        (("limits", "--frequency-ratio", "10", "--certify"), "needs --restitution"),
        (
            ("limits", "--law", "tsuji", "--restitution", "0.8", "--duration", "0.1", "--certify"),
            "--law",
        ),
        (
            ("limits", "--restitution", "1", "--frequency-ratio", "10", "--certify"),
            "without dissipation",
        ),
    ],
)
def test_what_cannot_be_certified_is_refused_in_one_line(refused, options, says):
    _, line = refused(*options)
    assert says in line


def test_a_missing_bifurcation_has_the_same_exit_status_as_without_a_proof(refused):
    without = ("limits", "--restitution", "1e-9", "--frequency-ratio", "10")
    for command in (without, (*without, "--certify")):
        status, line = refused(*command)
        assert status == 1 and "no saddle-node" in line


def test_the_command_prints_what_the_page_shows(said):
    [(command, shown)] = re.findall(r"```\n\$ bouncing-ball (.*)\n([^`]*)…\n```", PAGE)
    assert said(*shlex.split(command)).startswith(shown)
