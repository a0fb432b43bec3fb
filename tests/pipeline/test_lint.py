"""The linter's findings, and that the workflow has none left."""

import subprocess
import sys
from pathlib import Path

import pytest

import bouncing_ball
from bouncing_ball.pipeline.lint import ANSWERED, findings

pytestmark = pytest.mark.slow

ROOT = Path(bouncing_ball.__file__).resolve().parents[2]


def lint(folder):
    return subprocess.run(
        [sys.executable, "-m", "bouncing_ball.pipeline.lint"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_workflow_has_nothing_left():
    done = lint(ROOT)
    assert (done.returncode, done.stderr) == (0, "")
    assert "nothing left" in done.stdout


def test_what_is_left_fails(tmp_path):
    (tmp_path / "Snakefile").write_text(
        'rule copy:\n    output:\n        "a.txt",\n    shell:\n        "touch {output}"\n',
        encoding="utf-8",
    )
    done = lint(tmp_path)
    assert done.returncode == 1
    # The missing environment is a finding as well, and is not named.
    lines = done.stderr.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("rule copy (line 1") and lines[0].endswith(
        "No log directive defined"
    )


def test_a_workflow_that_cannot_be_read_fails(tmp_path):
    (tmp_path / "Snakefile").write_text("rule copy:\n    outputs: 1\n", encoding="utf-8")
    done = lint(tmp_path)
    assert done.returncode == 1 and "outputs" in done.stderr


def test_findings_of_several_rules():
    report = (
        "Using workflow specific profile\n"
        "Lints for snakefile Snakefile:\n    * Tab usage in line 3.:\n      Both\n\n"
        f"Lints for rule a (line 1, Snakefile):\n    * {ANSWERED}:\n      This way, the\n"
        "    * No log directive defined:\n      Without\n      Also see:\n      https://a.b\n"
    )
    assert findings(report) == [
        ("snakefile Snakefile", "Tab usage in line 3."),
        ("rule a (line 1, Snakefile)", ANSWERED),
        ("rule a (line 1, Snakefile)", "No log directive defined"),
    ]
