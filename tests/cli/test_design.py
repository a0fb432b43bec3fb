"""``bouncing-ball design``: keys, texts, exit statuses."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from bouncing_ball.cli.main import main

CASE = (
    "design",
    "--mass",
    "20 g",
    "--frequency",
    "50 Hz",
    "--acceleration",
    "0.8 g",
    "--restitution",
    "0.85",
)
STIFF = ("--stiffness", "1e7 N/m")


def asked(capsys, *arguments):
    main([*CASE, *arguments])
    out, err = capsys.readouterr()
    assert err == ""
    return out


def test_json_has_the_keys(capsys):
    found = json.loads(asked(capsys, *STIFF, "--json"))
    assert list(found)[:4] == ["frequency_ratio", "damping_ratio", "amplitude", "contact_time"]
    assert {"orbits", "verdict", "reason", "corrected", "time_step", "needed"} <= set(found)
    for one in found["orbits"]:
        assert {"n", "exists", "is_stable", "errors", "corrected_errors"} <= set(one)
        assert set(one["errors"]) == set(one["corrected_errors"])
    assert found["orbits"][0]["n"] == 1 and found["orbits"][0]["errors"]["max_height"] > 0.01
    assert isinstance(found["verdict"], str)


def test_what_is_infinite_is_null(capsys):
    # The saddle-node of an elastic ball is at Λ = 0: nothing to be relative to.
    main(["design", "--mass", "1", "--frequency", "1", "--acceleration", "0.5 g",
          "--restitution", "1", "--stiffness", "1e5", "--n", "1", "--json"])  # fmt: skip
    found = json.loads(capsys.readouterr().out)
    assert found["orbits"][0]["errors"]["saddle_node"] is None


def test_the_text_begins_with_the_verdict_of_the_readme(capsys):
    lines = asked(capsys, *STIFF).splitlines()
    assert lines[0].startswith("The restitution model is not good enough: the greatest height")
    assert lines[1].startswith("Reason: the contact's frequency ratio ϖ = 71.18 is below")
    text = "\n".join(lines)
    for word in (
        "contact time",
        "peak force",
        "force over weight",
        "largest time step",
        "3-T orbit",
    ):
        assert word in text
    readme = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
    assert lines[0] in readme and lines[1] in readme


def test_choosing(capsys):
    out = asked(capsys, "--quantity", "phase", "--tolerance", "0.1 %")
    assert out.startswith("A simulation needs a contact of at least ")
    assert "within 0.1 % of the restitution model's" in out


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (("--frequency", "20 ms"), 2, "it needs a frequency"),
        (("--stiffness", "-5 N/m"), 2, "not positive"),
        (("--damping", "3 N s/m"), 2, "contradict"),
        (("--acceleration", "0.1 g"), 1, "no n-T orbit in any model"),
        (("--n", "0"), 2, "whole number"),
        (("--release", "glue"), 2, "invalid choice"),
        (("--quantity", "colour"), 2, "one of max_height"),
        (("--plot", "page.jpg"), 2, "'page.jpg' does not end in .pdf or .png or .svg"),
        (("--plot", "page.png/"), 2, "'page.png/' does not end in .pdf or .png or .svg"),
    ],
)
def test_mistakes_are_one_line(capsys, arguments, status, says):
    with pytest.raises(SystemExit) as exit_:
        main([*CASE, *STIFF, *arguments])
    out, err = capsys.readouterr()
    assert exit_.value.code == status and out == ""
    assert says in err and err.count("\n") == 1


def test_only_units_need_pint():
    code = (
        "import sys; from bouncing_ball.cli.main import main; "
        "main('design --mass 1 --frequency 1 --acceleration 5 --stiffness 1e6 --restitution 0.9 "
        "--n 1 --json'.split()); sys.exit('pint' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 0 and done.stdout
