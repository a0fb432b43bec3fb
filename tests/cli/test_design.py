"""``bouncing-ball design``: keys, texts, exit statuses."""

import subprocess
import sys
from pathlib import Path

import pytest

TABLE = ("--frequency", "50 Hz", "--acceleration", "0.8 g")
CASE = ("design", "--mass", "20 g", *TABLE, "--restitution", "0.85")
STIFF = ("--stiffness", "1e7 N/m")


def test_json_has_the_keys(ask):
    found = ask(*CASE, *STIFF)
    assert list(found)[:4] == ["frequency_ratio", "damping_ratio", "amplitude", "contact_time"]
    assert {"orbits", "verdict", "reason", "corrected", "time_step", "needed"} <= set(found)
    for one in found["orbits"]:
        assert {"n", "exists", "is_stable", "errors", "corrected_errors"} <= set(one)
        assert set(one["errors"]) == set(one["corrected_errors"])
    assert found["orbits"][0]["n"] == 1 and found["orbits"][0]["errors"]["max_height"] > 0.01
    assert isinstance(found["verdict"], str)


def test_what_is_infinite_is_null(ask):
    # The saddle-node of an elastic ball is at Λ = 0: nothing to be relative to.
    case = "design --mass 1 --frequency 1 --acceleration 5 --restitution 1 --stiffness 1e5 --n 1"
    found = ask(*case.split())
    assert found["orbits"][0]["errors"]["saddle_node"] is None


def test_the_text_begins_with_the_verdict_of_the_readme(said):
    lines = said(*CASE, *STIFF).splitlines()
    assert lines[0].startswith("The restitution model is not good enough: the greatest height")
    assert lines[1].startswith("Reason: the contact's frequency ratio ϖ = 71.18 is below")
    text = "\n".join(lines)
    words = ("contact time", "peak force", "force over weight", "largest time step", "3-T orbit")
    assert all(word in text for word in words)
    readme = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
    assert lines[0] in readme and lines[1] in readme


def test_choosing(said):
    out = said(*CASE, "--quantity", "phase", "--tolerance", "0.1 %")
    assert out.startswith("A simulation needs a contact of at least ")
    words = "the phase of impact of the 1-T orbit is then within 0.1 % of the restitution model's"
    assert words in out


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (("--frequency", "20 ms"), 2, "it needs a frequency"),
        (("--stiffness", "-5 N/m"), 2, "not positive"),
        (("--stiffness", "-5N/m"), 2, "stiffness = -5 N/m is not positive"),
        (("--stiffness", "-1e6"), 2, "stiffness = -1e+06 N/m is not positive"),
        (("--damping", "3 N s/m"), 2, "contradict"),
        (("--acceleration", "0.1 g"), 1, "no n-T orbit in any model"),
        (("--n", "0"), 2, "whole number"),
        (("--release", "glue"), 2, "invalid choice"),
        (("--quantity", "colour"), 2, "one of max_height"),
        (("--plot", "page.jpg"), 2, "'page.jpg' does not end in .pdf or .png or .svg"),
        (("--plot", "page.png/"), 2, "'page.png/' does not end in .pdf or .png or .svg"),
    ],
)
def test_mistakes_are_one_line(refused, arguments, status, says):
    code, line = refused(*CASE, *STIFF, *arguments)
    assert code == status and says in line


def test_only_units_need_pint():
    code = (
        "import sys; from bouncing_ball.cli.main import main; "
        "main('design --mass 1 --frequency 1 --acceleration 5 --stiffness 1e6 --restitution 0.9 "
        "--n 1 --json'.split()); sys.exit('pint' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 0 and done.stdout
